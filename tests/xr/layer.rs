//! A layer between app and runtime that lets calls fail: what a test writes into a file is what the runtime answers.
//!
//! `/out/fail` holds lines like `xrLocateSpace -1`: that function, and the result it gives. Every other call goes through.
//! The loader takes it up by `XR_API_LAYER_PATH` and `XR_ENABLE_API_LAYERS=XR_APILAYER_MIDAIR_fail`.

mod calls;

use std::ffi::{CStr, c_char};
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

use calls::{FRAME, START};
use openxr::sys;
use sys::loader::{
    ApiLayerCreateInfo, CURRENT_LOADER_API_LAYER_VERSION, XrNegotiateApiLayerRequest,
    XrNegotiateLoaderInfo,
};

/// Others that can be refused.
const OTHER: [&str; 8] = [
    "xrPollEvent",
    "xrGetCurrentInteractionProfile",
    "xrApplyHapticFeedback",
    "xrBeginSession",
    "xrEndSession",
    "xrRequestExitSession",
    "xrSuggestInteractionProfileBindings",
    "xrCreateReferenceSpace",
];

/// What can fail. (`xrCreateInstance`, the first of a start, goes another way.)
const NAMES: [&str; FRAME.len() + START.len() + OTHER.len()] = {
    let mut names = [""; FRAME.len() + START.len() + OTHER.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = if i < FRAME.len() {
            FRAME[i]
        } else if i < FRAME.len() + START.len() {
            START[i - FRAME.len()]
        } else {
            OTHER[i - FRAME.len() - START.len()]
        };
        i += 1;
    }
    names
};

static REAL: [AtomicUsize; NAMES.len()] = [const { AtomicUsize::new(0) }; NAMES.len()];
static NEXT: AtomicUsize = AtomicUsize::new(0);

/// A call of any of them: none has more than six arguments, all of them fit registers.
type Call = unsafe extern "system" fn(usize, usize, usize, usize, usize, usize) -> i32;

/// The result that a function is to give instead of its own.
fn fails(name: &str) -> Option<i32> {
    let text = fs::read_to_string("/out/fail").ok()?;
    text.lines().find_map(|line| {
        let (call, code) = line.split_once(' ')?;
        (call == name).then(|| code.trim().parse().ok())?
    })
}

unsafe extern "system" fn shim<const I: usize>(
    a: usize,
    b: usize,
    c: usize,
    d: usize,
    e: usize,
    f: usize,
) -> i32 {
    if let Some(code) = fails(NAMES[I]) {
        return code;
    }
    let real = REAL[I].load(Ordering::Relaxed);
    // SAFETY: it was stored as the function of that name; arguments that it does not have are left in registers.
    unsafe { std::mem::transmute::<usize, Call>(real)(a, b, c, d, e, f) }
}

macro_rules! shims {
    ($($i:literal)*) => { [$(shim::<$i> as Call),*] };
}

const SHIMS: [Call; NAMES.len()] = shims!(
    0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 33 34 35 36
);

unsafe extern "system" fn get_instance_proc_addr(
    instance: sys::Instance,
    name: *const c_char,
    function: *mut Option<sys::pfn::VoidFunction>,
) -> sys::Result {
    let next = NEXT.load(Ordering::Relaxed);
    // SAFETY: the loader gave it when the instance was made; `name` and `function` are the caller's.
    unsafe {
        let next = std::mem::transmute::<usize, sys::pfn::GetInstanceProcAddr>(next);
        let result = next(instance, name, function);
        let asked = CStr::from_ptr(name).to_str().unwrap_or_default();
        if let (Some(real), Some(i)) = (*function, NAMES.iter().position(|n| *n == asked)) {
            REAL[i].store(real as usize, Ordering::Relaxed);
            *function = Some(std::mem::transmute::<Call, sys::pfn::VoidFunction>(
                SHIMS[i],
            ));
        }
        result
    }
}

unsafe extern "system" fn create_api_layer_instance(
    info: *const sys::InstanceCreateInfo,
    layer: *const ApiLayerCreateInfo,
    instance: *mut sys::Instance,
) -> sys::Result {
    if let Some(code) = fails("xrCreateInstance") {
        return sys::Result::from_raw(code);
    }
    // SAFETY: the loader's own structures.
    unsafe {
        let next = &*(*layer).next_info;
        NEXT.store(next.next_get_instance_proc_addr as usize, Ordering::Relaxed);
        let mut rest = *layer;
        rest.next_info = next.next;
        (next.next_create_api_layer_instance)(info, &raw const rest, instance)
    }
}

/// What the loader asks first.
///
/// # Safety
///
/// Called by the loader with its own structures.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub unsafe extern "system" fn xrNegotiateLoaderApiLayerInterface(
    _loader: *const XrNegotiateLoaderInfo,
    _name: *const c_char,
    request: *mut XrNegotiateApiLayerRequest,
) -> sys::Result {
    // SAFETY: the loader gives a structure of that type.
    let request = unsafe { &mut *request };
    request.layer_interface_version = CURRENT_LOADER_API_LAYER_VERSION;
    request.layer_api_version = sys::Version::new(1, 0, 34);
    request.get_instance_proc_addr = Some(get_instance_proc_addr);
    request.create_api_layer_instance = Some(create_api_layer_instance);
    sys::Result::SUCCESS
}
