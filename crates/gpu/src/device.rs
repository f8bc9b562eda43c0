use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use crate::error::GpuError;
use crate::kernels::{For, Kernels, sources};
use crate::wait::block_on;

/// Which adapter may be used, and for how much.
#[derive(Clone, Debug)]
pub struct GpuOptions {
    /// Software that plays a graphics card (Mesa's llvmpipe) counts as well.
    pub software: bool,
    /// The most bytes of device memory for one solid.
    pub budget: u64,
}

impl Default for GpuOptions {
    /// A real card, 1 GiB.
    fn default() -> Self {
        Self {
            software: false,
            budget: 1 << 30,
        }
    }
}

/// What a graphics card is called and whether it is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// Its name as its driver says it.
    pub name: String,
    /// Vulkan, Metal or Direct3D 12.
    pub api: String,
    /// It is the processor in disguise.
    pub software: bool,
}

/// A device with its passes compiled. Can be shared between threads.
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) plain: Kernels,
    quantised: OnceLock<Result<Kernels, GpuError>>,
    painted: OnceLock<Result<Kernels, GpuError>>,
    /// Why it was lost, once it is.
    lost: Arc<Mutex<Option<String>>>,
    adapter: Adapter,
    pub(crate) limits: wgpu::Limits,
    pub(crate) budget: u64,
    /// The largest buffer that there is said to be memory for.
    pub(crate) left: AtomicU64,
    /// The device is somebody else's as well, who draws with it.
    shared: bool,
    /// Nanoseconds to a tick, where the device measures times.
    pub(crate) tick: Option<f32>,
}

/// Limits without which no pass runs: what, how many.
fn needs(limits: &wgpu::Limits) -> [(&'static str, u64, u64); 5] {
    let l = limits;
    [
        (
            "invocations in a workgroup",
            l.max_compute_invocations_per_workgroup.into(),
            256,
        ),
        (
            "bytes of workgroup memory",
            l.max_compute_workgroup_storage_size.into(),
            16_384,
        ),
        (
            "storage buffers in a pass",
            l.max_storage_buffers_per_shader_stage.into(),
            8,
        ),
        (
            "bytes of a storage buffer",
            l.max_storage_buffer_binding_size,
            128 << 20,
        ),
        (
            "workgroups along an axis",
            l.max_compute_workgroups_per_dimension.into(),
            32_768,
        ),
    ]
}

/// An error where an adapter allows less than is needed, or than a test asks for.
fn enough(limits: &wgpu::Limits, adapter: &str, at_least: &wgpu::Limits) -> Result<(), GpuError> {
    let least = at_least == &wgpu::Limits::default();
    let asked = needs(at_least).map(|(_, has, _)| has);
    for ((what, has, needs), asked) in needs(limits).into_iter().zip(asked) {
        let needs = needs.max(if least { 0 } else { asked });
        if has < needs {
            return Err(GpuError::Limit {
                adapter: adapter.to_owned(),
                what,
                has,
                needs,
            });
        }
    }
    Ok(())
}

impl Gpu {
    /// All adapters of this machine, the ones to be preferred first.
    pub fn adapters() -> Vec<Adapter> {
        found().iter().map(describe).collect()
    }

    /// Opens the adapter to be preferred.
    ///
    /// # Errors
    /// There is none, or only one that does not fit `options` or is too small, or a pass does not compile.
    pub fn open(options: &GpuOptions) -> Result<Self, GpuError> {
        Self::open_with(options, &sources(), &wgpu::Limits::default())
    }

    /// As [`Gpu::open`], with other sources and at least these limits: for tests of what may be missing.
    pub(crate) fn open_with(
        options: &GpuOptions,
        sources: &[(String, String)],
        at_least: &wgpu::Limits,
    ) -> Result<Self, GpuError> {
        let all = found();
        let first = all.first().ok_or(GpuError::NoAdapter)?;
        let described = describe(first);
        if described.software && !options.software {
            return Err(GpuError::Software(described.name));
        }
        Self::of(first, described, options, sources, at_least)
    }

    /// On a device that somebody else opened and draws with: surfaces that are made on it can be drawn without
    /// coming back to main memory ([`GpuSolid::emit`](crate::GpuSolid::emit)). Its owner watches over its loss.
    ///
    /// # Errors
    /// As [`Gpu::open`].
    pub fn share(
        device: wgpu::Device,
        queue: wgpu::Queue,
        adapter: Adapter,
        options: &GpuOptions,
    ) -> Result<Self, GpuError> {
        if adapter.software && !options.software {
            return Err(GpuError::Software(adapter.name));
        }
        let limits = device.limits();
        enough(&limits, &adapter.name, &wgpu::Limits::default())?;
        let timed = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let plain = Kernels::compile(&device, &sources(), For::Plain)?;
        Ok(Self {
            tick: timed.then(|| queue.get_timestamp_period()),
            device,
            queue,
            plain,
            quantised: OnceLock::new(),
            painted: OnceLock::new(),
            lost: Arc::default(),
            adapter,
            limits,
            budget: options.budget,
            left: AtomicU64::new(u64::MAX),
            shared: true,
        })
    }

    fn of(
        adapter: &wgpu::Adapter,
        described: Adapter,
        options: &GpuOptions,
        sources: &[(String, String)],
        at_least: &wgpu::Limits,
    ) -> Result<Self, GpuError> {
        let limits = adapter.limits();
        enough(&limits, &described.name, at_least)?;
        let timed = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let refused = |e: wgpu::RequestDeviceError| GpuError::Device {
            adapter: described.name.clone(),
            reason: e.to_string(),
        };
        let (device, queue) = block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("midair"),
            required_features: if timed {
                wgpu::Features::TIMESTAMP_QUERY
            } else {
                wgpu::Features::empty()
            },
            required_limits: limits.clone(),
            ..Default::default()
        }))
        .map_err(refused)?;
        let lost: Arc<Mutex<Option<String>>> = Arc::default();
        let told = lost.clone();
        device.set_device_lost_callback(move |reason, message| {
            if let Ok(mut lost) = told.lock() {
                let why = if message.is_empty() {
                    format!("{reason:?}")
                } else {
                    message
                };
                lost.get_or_insert(why);
            }
        });
        // What no scope catches is told by the step that waits next; wgpu's own answer is a panic.
        let told = lost.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let (Ok(mut lost), wgpu::Error::Internal { .. }) = (told.lock(), &error) {
                lost.get_or_insert(error.to_string());
            }
        }));
        let plain = Kernels::compile(&device, sources, For::Plain)?;
        let tick = timed.then(|| queue.get_timestamp_period());
        Ok(Self {
            device,
            queue,
            plain,
            quantised: OnceLock::new(),
            painted: OnceLock::new(),
            lost,
            adapter: described,
            limits,
            budget: options.budget,
            left: AtomicU64::new(u64::MAX),
            shared: false,
            tick,
        })
    }

    /// The passes for what is to be made; compiled when they are first asked for.
    pub(crate) fn kernels(&self, made_for: For) -> Result<&Kernels, GpuError> {
        let kept = match made_for {
            For::Plain => return Ok(&self.plain),
            For::Quantised => &self.quantised,
            For::Painted => &self.painted,
        };
        let made = kept.get_or_init(|| Kernels::compile(&self.device, &sources(), made_for));
        made.as_ref().map_err(Clone::clone)
    }

    /// What it runs on.
    pub fn adapter(&self) -> &Adapter {
        &self.adapter
    }

    /// The most bytes of device memory for one solid.
    pub fn budget(&self) -> u64 {
        self.budget
    }

    /// From here on a buffer of more than so many bytes finds no memory left, as on a card that others have filled:
    /// `None` for what there is. A test of what then happens.
    pub fn starve(&self, most: Option<u64>) {
        self.left.store(most.unwrap_or(u64::MAX), Ordering::Relaxed);
    }

    /// Whether somebody else draws with the device.
    pub fn is_shared(&self) -> bool {
        self.shared
    }

    /// Does some work and tells what the device minded on the way. What nobody watches for ends whoever draws with it.
    pub(crate) fn watched<T>(
        &self,
        work: impl FnOnce() -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        use wgpu::ErrorFilter as Of;
        let scopes = [Of::Internal, Of::OutOfMemory, Of::Validation];
        let scopes = scopes.map(|of| self.device.push_error_scope(of));
        let done = work();
        // The one that was opened last is closed first.
        let mut minded = None;
        for scope in scopes.into_iter().rev() {
            minded = block_on(scope.pop()).or(minded);
        }
        self.check()?;
        let done = done?;
        match minded {
            None => Ok(done),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(GpuError::Full),
            Some(e) => Err(GpuError::refused(&e)),
        }
    }

    /// Whether the device measures how long passes take.
    pub fn is_timed(&self) -> bool {
        self.tick.is_some()
    }

    /// An error once the device is gone.
    ///
    /// # Errors
    /// [`GpuError::Lost`].
    pub fn check(&self) -> Result<(), GpuError> {
        let lost = self.lost.lock();
        match lost.ok().and_then(|l| l.clone()) {
            Some(why) => Err(GpuError::Lost(why)),
            None => Ok(()),
        }
    }

    /// Loses the device on purpose: everything on it is gone, every further call an error.
    pub fn lose(&self) {
        self.device.destroy();
        let _ = self.device.poll(wgpu::PollType::Poll);
        if let Ok(mut lost) = self.lost.lock() {
            lost.get_or_insert_with(|| "given up".to_owned());
        }
    }

    /// Runs what was submitted to its end.
    pub(crate) fn wait(&self) -> Result<(), GpuError> {
        self.check()?;
        // What is software may be at it for minutes; a card that is has hung.
        let patience = if self.adapter.software { 1200 } else { 120 };
        let waited = self.device.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(std::time::Duration::from_secs(patience)),
        });
        self.check()?;
        match waited {
            Ok(_) => Ok(()),
            Err(e) => {
                // A queue whose work never ends panics when it is dropped: a card that hangs keeps both.
                std::mem::forget((self.device.clone(), self.queue.clone()));
                Err(GpuError::Lost(e.to_string()))
            }
        }
    }
}

impl std::fmt::Debug for Gpu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gpu")
            .field("adapter", &self.adapter)
            .finish_non_exhaustive()
    }
}

/// Real cards before software, discrete ones first.
pub(crate) fn found() -> Vec<wgpu::Adapter> {
    let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        // How many groups a pass has is written by `args` alone, within the limits: nobody needs to look again.
        flags: wgpu::InstanceFlags::default() - wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let mut all = block_on(instance.enumerate_adapters(backends));
    all.sort_by_key(|a| match a.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    all
}

pub(crate) fn describe(adapter: &wgpu::Adapter) -> Adapter {
    let info = adapter.get_info();
    Adapter {
        name: info.name,
        api: format!("{:?}", info.backend),
        software: info.device_type == wgpu::DeviceType::Cpu,
    }
}
