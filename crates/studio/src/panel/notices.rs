use bevy_egui::egui::{RichText, Ui};

use crate::notice::{Notices, Weight};

/// Seconds for which a line stays: long enough to read it twice.
pub const STAYS: f64 = 8.0;

/// The latest lines; says whether there are any.
pub fn notices(ui: &mut Ui, notices: &Notices) -> bool {
    let mut any = false;
    let recent: Vec<_> = notices.recent(STAYS).collect();
    for notice in recent.iter().rev().take(4).rev() {
        let text = RichText::new(&notice.text);
        ui.label(match notice.weight {
            Weight::Info => text,
            Weight::Warning => text.color(ui.visuals().warn_fg_color),
        });
        any = true;
    }
    any
}
