//! The calls of OpenXR that a test lets fail, by name: what the layer can refuse, and what the test refuses in turn.

/// Calls of every frame: refused, the session goes on.
pub const FRAME: [&str; 12] = [
    "xrWaitFrame",
    "xrBeginFrame",
    "xrEndFrame",
    "xrAcquireSwapchainImage",
    "xrWaitSwapchainImage",
    "xrReleaseSwapchainImage",
    "xrLocateViews",
    "xrLocateSpace",
    "xrSyncActions",
    "xrGetActionStateBoolean",
    "xrGetActionStateFloat",
    "xrGetActionStateVector2f",
];

/// Calls of a start: refused, there is no session, and another try follows.
pub const START: [&str; 17] = [
    "xrCreateInstance",
    "xrGetInstanceProperties",
    "xrGetSystem",
    "xrGetSystemProperties",
    "xrGetVulkanGraphicsRequirements2KHR",
    "xrGetVulkanGraphicsDevice2KHR",
    "xrCreateSession",
    "xrEnumerateViewConfigurationViews",
    "xrEnumerateSwapchainFormats",
    "xrCreateSwapchain",
    "xrEnumerateSwapchainImages",
    "xrEnumerateEnvironmentBlendModes",
    "xrStringToPath",
    "xrCreateActionSet",
    "xrCreateAction",
    "xrAttachSessionActionSets",
    "xrCreateActionSpace",
];
