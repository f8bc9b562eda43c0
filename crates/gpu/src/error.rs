/// Why the GPU did not do it. The processor can always do it instead.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// No adapter at all.
    #[error(
        "no graphics card with Vulkan, Metal or Direct3D 12 was found; solids are made by the processor"
    )]
    NoAdapter,
    /// There are only adapters that are the processor in disguise, and a real one was asked for.
    #[error("{0} is no graphics card but software; solids are made by the processor")]
    Software(String),
    /// An adapter that is too small.
    #[error(
        "{adapter} allows {has} for {what}, {needs} are needed; solids are made by the processor"
    )]
    Limit {
        /// Its name.
        adapter: String,
        /// Which limit.
        what: &'static str,
        /// What it allows.
        has: u64,
        /// What is needed.
        needs: u64,
    },
    /// The adapter refused to be opened.
    #[error("{adapter} cannot be used: {reason}; solids are made by the processor")]
    Device {
        /// Its name.
        adapter: String,
        /// What it said.
        reason: String,
    },
    /// A pass that does not compile.
    #[error("the shader {name} does not compile: {reason}")]
    Shader {
        /// Which one.
        name: String,
        /// What the compiler said, first line.
        reason: String,
    },
    /// The device has no memory left.
    #[error("the graphics card has no {} left for {what}", mib(*bytes))]
    OutOfMemory {
        /// What they were for.
        what: &'static str,
        /// How many were asked for.
        bytes: u64,
    },
    /// The device has no memory left for its own needs.
    #[error("the graphics card has no memory left for a pass")]
    Full,
    /// More memory than was granted to the solid, or than one buffer of the device may have.
    #[error(
        "the solid needs {} of the graphics card's memory for {what}, {} are granted; choose a larger step",
        mib(*needs),
        mib(*budget)
    )]
    Budget {
        /// What they are for.
        what: &'static str,
        /// How many.
        needs: u64,
        /// How many there may be.
        budget: u64,
    },
    /// The device is gone: unplugged, reset, or its driver restarted.
    #[error("the graphics card was lost: {0}")]
    Lost(String),
    /// Something that only the processor knows how to evaluate.
    #[error("{0} cannot be evaluated on the GPU")]
    Unsupported(&'static str),
    /// Further out or finer than coordinates on the device reach.
    #[error("at a step of {0} m the solid is too large for the GPU; choose a larger step")]
    TooFine(f32),
    /// The device refused what it was told: a mistake of ours.
    #[error("the graphics card refused a pass: {0}")]
    Refused(String),
}

/// Bytes for people.
pub(crate) fn mib(bytes: u64) -> String {
    match bytes >> 20 {
        0 => format!("{bytes} bytes"),
        n if n % 1024 == 0 => format!("{} GiB", n / 1024),
        n => format!("{n} MiB"),
    }
}

impl GpuError {
    /// What the device said, in one line.
    pub(crate) fn refused(said: &impl std::fmt::Display) -> Self {
        let said = said.to_string();
        let words: Vec<&str> = said.split_whitespace().collect();
        Self::Refused(words.join(" "))
    }
}
