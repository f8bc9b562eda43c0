//! Why there is no headset, in words that say what to do.

use bevy_mod_openxr::error::OxrError;
use openxr::sys::Result as Code;

use super::active_runtime;

/// Why the headset cannot be used. Each says the way out on this platform.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RuntimeFault {
    /// No loader is installed.
    #[error("the OpenXR loader was not found ({reason}). {}", way_to_loader())]
    NoLoader {
        /// What the system says.
        reason: String,
    },
    /// No runtime answers.
    #[error("no OpenXR runtime answers{}. {}", named(), way_to_runtime())]
    NoRuntime,
    /// A runtime, but no headset.
    #[error(
        "{runtime} runs, but no headset is connected to it. Plug the headset in and switch it on, wait until {runtime} \
         shows it, then try again"
    )]
    NoHeadset {
        /// The runtime's name.
        runtime: String,
    },
    /// It lacks what Midair cannot do without.
    #[error(
        "the OpenXR runtime{} does not offer {name}, which Midair draws with. Update the runtime, or make another one \
         active. {}",
        named(),
        way_to_switch()
    )]
    NoExtension {
        /// The extension.
        name: String,
    },
    /// The runtime wants another graphics card or driver than there is.
    #[error(
        "{runtime} and the graphics card do not come together: {reason}. Update the card's driver, then try again"
    )]
    NoGraphics {
        /// The runtime's name.
        runtime: String,
        /// What went wrong.
        reason: String,
    },
    /// A call was refused.
    #[error("{runtime} refused {call} ({code}). Start {runtime} again, then try again")]
    Refused {
        /// The runtime's name.
        runtime: String,
        /// The OpenXR function.
        call: &'static str,
        /// The result it gave.
        code: String,
    },
}

impl RuntimeFault {
    /// What a refused call means before the runtime's name is known.
    pub(crate) fn early(call: &'static str, code: Code) -> Self {
        match code {
            Code::ERROR_RUNTIME_UNAVAILABLE
            | Code::ERROR_RUNTIME_FAILURE
            | Code::ERROR_FILE_ACCESS_ERROR
            | Code::ERROR_FILE_CONTENTS_INVALID
            | Code::ERROR_INSTANCE_LOST
            | Code::ERROR_INITIALIZATION_FAILED => Self::NoRuntime,
            _ => Self::refused("the OpenXR runtime", call, code),
        }
    }

    pub(crate) fn refused(runtime: &str, call: &'static str, code: Code) -> Self {
        match code {
            Code::ERROR_FORM_FACTOR_UNAVAILABLE => Self::NoHeadset {
                runtime: runtime.to_owned(),
            },
            _ => Self::Refused {
                runtime: runtime.to_owned(),
                call,
                code: format!("{code:?}"),
            },
        }
    }

    pub(crate) fn of(runtime: &str, call: &'static str, error: OxrError) -> Self {
        match error {
            OxrError::OpenXrError(code) => Self::refused(runtime, call, code),
            OxrError::UnavailableBackend(_) => Self::NoExtension {
                name: "XR_KHR_vulkan_enable2".to_owned(),
            },
            other => Self::NoGraphics {
                runtime: runtime.to_owned(),
                reason: other.to_string(),
            },
        }
    }
}

fn named() -> String {
    active_runtime().map_or(String::new(), |path| {
        format!(" (the active one is {})", path.display())
    })
}

fn way_to_loader() -> &'static str {
    if cfg!(target_os = "linux") {
        "Install it: sudo apt install libopenxr-loader1 (Debian, Ubuntu), openxr-libs (Fedora), openxr (Arch); or set \
         MIDAIR_OPENXR_LOADER to where it lies"
    } else {
        "Install Midair again, since it lies beside it"
    }
}

fn way_to_runtime() -> &'static str {
    if cfg!(windows) {
        "Start SteamVR (or the program that came with the headset) and make it the active runtime: SteamVR, Settings, \
         OpenXR, Set SteamVR as OpenXR runtime"
    } else {
        "Start SteamVR (or monado-service) and make it the active runtime: SteamVR, Settings, OpenXR, Set SteamVR as \
         OpenXR runtime; or link ~/.config/openxr/1/active_runtime.json to its manifest"
    }
}

fn way_to_switch() -> &'static str {
    if cfg!(windows) {
        "In SteamVR: Settings, OpenXR, Set SteamVR as OpenXR runtime"
    } else {
        "~/.config/openxr/1/active_runtime.json says which one is"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fault_is_one_line_with_a_way_out() {
        let name = || "Monado".to_owned();
        let faults = [
            RuntimeFault::NoLoader {
                reason: "no such file".to_owned(),
            },
            RuntimeFault::early("xrCreateInstance", Code::ERROR_RUNTIME_UNAVAILABLE),
            RuntimeFault::early("xrCreateInstance", Code::ERROR_LIMIT_REACHED),
            RuntimeFault::refused("Monado", "xrGetSystem", Code::ERROR_FORM_FACTOR_UNAVAILABLE),
            RuntimeFault::refused("Monado", "xrCreateSession", Code::ERROR_OUT_OF_MEMORY),
            RuntimeFault::NoExtension { name: name() },
            RuntimeFault::NoGraphics {
                runtime: name(),
                reason: "a device is lost".to_owned(),
            },
        ];
        for fault in faults {
            let line = fault.to_string();
            assert!(!line.contains('\n'), "{line}");
            let ways = ["tart", "nstall", "lug", "pdate"];
            assert!(ways.iter().any(|w| line.contains(w)), "{line}");
        }
    }
}
