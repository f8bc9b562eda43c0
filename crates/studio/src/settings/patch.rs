//! One setting by its name: `look.room = "Day"`.

use serde_json::Value;

use super::{SHAPING, Settings};
use crate::command::Command;

/// Why a setting was not changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettingFault {
    /// No setting has that name.
    #[error("there is no setting \"{0}\". docs/session.md lists them")]
    Unknown(String),
    /// The value does not fit.
    #[error("the setting \"{key}\" cannot be {value}: {reason}")]
    Value {
        /// Its name.
        key: String,
        /// What it was to be.
        value: String,
        /// Why not.
        reason: String,
    },
}

impl Settings {
    /// Sets one value by its dotted name. `value` is JSON: `true`, `0.05`, `"Day"`, `[1, 2]`.
    ///
    /// # Errors
    ///
    /// No setting has that name, or the value is not one for it; nothing changes then.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), SettingFault> {
        let fault = |reason: String| SettingFault::Value {
            key: key.to_owned(),
            value: value.to_owned(),
            reason,
        };
        let parsed: Value = serde_json::from_str(value).map_err(|e| fault(e.to_string()))?;
        let mut whole = serde_json::to_value(&*self).map_err(|e| fault(e.to_string()))?;
        let slot = whole
            .pointer_mut(&format!("/{}", key.replace('.', "/")))
            .ok_or_else(|| SettingFault::Unknown(key.to_owned()))?;
        *slot = parsed;
        *self = serde_json::from_value(whole).map_err(|e| fault(e.to_string()))?;
        Ok(())
    }

    /// The command that sets `key` to `value`.
    pub fn command(key: &str, value: impl serde::Serialize) -> Command {
        Command::Set {
            key: key.to_owned(),
            value: serde_json::to_string(&value).unwrap_or_default(),
        }
    }

    /// The commands that make defaults into these settings, as far as they change what hands make.
    pub fn shaping(&self) -> Vec<Command> {
        let (Ok(Value::Object(now)), Ok(before)) = (
            serde_json::to_value(self),
            serde_json::to_value(Self::default()),
        ) else {
            return Vec::new();
        };
        let parts = now
            .iter()
            .filter(|(key, _)| SHAPING.contains(&key.as_str()));
        parts
            .filter(|(key, value)| before.get(key) != Some(value))
            .map(|(key, value)| Command::Set {
                key: key.clone(),
                value: value.to_string(),
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::RoomKind;

    #[test]
    fn a_setting_is_changed_by_its_name() {
        let mut settings = Settings::default();
        settings.set("look.room", "\"Day\"").unwrap();
        assert_eq!(settings.look.room, RoomKind::Day);
    }

    #[test]
    fn an_unknown_name_and_an_unfit_value_change_nothing() {
        let mut settings = Settings::default();
        for (key, value) in [
            ("look.rom", "1"),
            ("look.room", "\"Night\""),
            ("look.room", "{"),
            ("look.interface_scale", "\"wide\""),
        ] {
            assert!(settings.set(key, value).is_err(), "{key}");
        }
        assert_eq!(settings, Settings::default());
    }
}
