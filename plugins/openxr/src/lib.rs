//! The headset as a way in.
