//! An instance of a runtime that has a headset.

use std::borrow::Cow;

use bevy_mod_openxr::graphics::{GraphicsBackend, GraphicsWrap};
use bevy_mod_openxr::resources::{OxrEntry, OxrInstance, SessionGraphicsCreateInfo};
use bevy_mod_openxr::types::{AppInfo, OxrExtensions, Version, WgpuGraphics};

use super::{RuntimeFault, loader};

/// What draws in the headset, as the runtime chose it; it outlives a runtime that dies.
#[derive(Clone)]
pub struct Card(pub(crate) SessionGraphicsCreateInfo);

/// A runtime with a headset.
#[derive(Clone)]
pub struct Connection {
    pub(crate) instance: OxrInstance,
    pub(crate) system: openxr::SystemId,
    pub(crate) extensions: openxr::ExtensionSet,
    /// What the runtime calls itself.
    pub runtime: String,
    /// What it calls the headset.
    pub headset: String,
}

impl Connection {
    /// Finds the loader, the active runtime and its headset. It may take seconds: some runtimes start with it.
    ///
    /// # Errors
    ///
    /// Any of them is missing.
    pub fn open() -> Result<Self, RuntimeFault> {
        let entry = OxrEntry(loader::open()?);
        let offered = entry
            .0
            .enumerate_extensions()
            .map_err(|code| RuntimeFault::early("xrEnumerateInstanceExtensionProperties", code))?;
        if !offered.khr_vulkan_enable2 {
            return Err(RuntimeFault::NoExtension {
                name: "XR_KHR_vulkan_enable2".to_owned(),
            });
        }
        let mut wanted = openxr::ExtensionSet::default();
        // Controllers that are not in the core of OpenXR.
        wanted.ext_hp_mixed_reality_controller = offered.ext_hp_mixed_reality_controller;
        wanted.bd_controller_interaction = offered.bd_controller_interaction;
        let info = AppInfo {
            name: Cow::Borrowed("Midair"),
            version: Version(0, 1, 0),
        };
        let instance = entry
            .create_instance(
                info,
                OxrExtensions::from(wanted.clone()),
                &[],
                GraphicsBackend::Vulkan(()),
            )
            .map_err(|error| match error {
                bevy_mod_openxr::error::OxrError::OpenXrError(code) => {
                    RuntimeFault::early("xrCreateInstance", code)
                }
                other => RuntimeFault::of("the OpenXR runtime", "xrCreateInstance", other),
            })?;
        let runtime = match instance.properties() {
            Ok(properties) => properties.runtime_name,
            Err(code) => return Err(RuntimeFault::early("xrGetInstanceProperties", code)),
        };
        let refused = |call| {
            let runtime = runtime.clone();
            move |code| RuntimeFault::refused(&runtime, call, code)
        };
        let system = instance
            .system(openxr::FormFactor::HEAD_MOUNTED_DISPLAY)
            .map_err(refused("xrGetSystem"))?;
        let headset = instance
            .system_properties(system)
            .map_err(refused("xrGetSystemProperties"))?
            .system_name;
        Ok(Self {
            instance,
            system,
            extensions: wanted,
            runtime,
            headset,
        })
    }

    /// Opens the graphics card that the runtime draws with, once per process.
    pub(crate) fn card(&self) -> Result<(WgpuGraphics, Card), RuntimeFault> {
        self.instance
            .init_graphics(self.system, None)
            .map(|(graphics, info)| (graphics, Card(info)))
            .map_err(|error| {
                RuntimeFault::of(&self.runtime, "xrGetVulkanGraphicsRequirements2KHR", error)
            })
    }

    /// Tells a runtime that came back which card draws already.
    ///
    /// # Errors
    ///
    /// It wants another one now.
    pub(crate) fn adopt(&self, card: &Card) -> Result<(), RuntimeFault> {
        let refused = |call| move |code| RuntimeFault::refused(&self.runtime, call, code);
        let GraphicsWrap::Vulkan(info) = &card.0.0;
        self.instance
            .graphics_requirements::<openxr::Vulkan>(self.system)
            .map_err(refused("xrGetVulkanGraphicsRequirements2KHR"))?;
        // SAFETY: the Vulkan instance was made for the first connection and lives as long as the process.
        let wanted = unsafe {
            self.instance
                .vulkan_graphics_device(self.system, info.instance)
        }
        .map_err(refused("xrGetVulkanGraphicsDevice2KHR"))?;
        if wanted != info.physical_device {
            return Err(RuntimeFault::NoGraphics {
                runtime: self.runtime.clone(),
                reason: "it draws with another card than before, so Midair has to be started again"
                    .to_owned(),
            });
        }
        Ok(())
    }
}
