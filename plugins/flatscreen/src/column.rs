//! The panels of one side of the window, one above the other.

use bevy::prelude::*;
use bevy_egui::egui;
use midair_studio::{
    command::Command,
    panel::{self, PanelInfo, Panels},
};

use crate::focus::Map;
use crate::panels::{fill, heading};

/// Draws them, as high as the window is.
pub(crate) fn column(
    root: &mut egui::Ui,
    side: egui::Panel,
    open: &[PanelInfo],
    world: &World,
    panels: &mut Panels,
    map: &mut Map,
    asks: &mut Vec<Command>,
) {
    side.resizable(true)
        .size_range(200.0..=480.0)
        .show(root, |ui| {
            map.begin();
            let height = |info: &PanelInfo| egui::Id::new(("height", info.id));
            let needs: Vec<Option<f32>> = open
                .iter()
                .map(|info| ui.data(|d| d.get_temp(height(info))).flatten())
                .collect();
            let shares = shares(&needs, ui.available_height());
            for (i, (info, share)) in open.iter().zip(shares).enumerate() {
                let top = ui.cursor().top();
                if i > 0 {
                    ui.separator();
                }
                ui.set_opacity(panel::kit::appeared(ui, egui::Id::new(info.id)));
                ui.add_space(8.0);
                heading(ui, info, asks);
                ui.push_id(info.id, |ui| {
                    let bottom = top + share;
                    ui.set_max_height(
                        (bottom - ui.cursor().top() - ui.spacing().item_spacing.y).max(80.0),
                    );
                    fill(ui, info, world, panels, asks);
                });
                let used = ui.cursor().top() - top;
                let need = (used < share - 0.5 * SLACK).then_some(used);
                ui.data_mut(|d| d.insert_temp(height(info), need));
                map.end(info.id, true);
            }
        });
}

/// Points that a panel has beyond what it needed, to grow into.
const SLACK: f32 = 24.0;

/// How high each panel of a column may be: all the same, but what one does not need is the others'. `None` needs
/// what it gets.
fn shares(needs: &[Option<f32>], height: f32) -> Vec<f32> {
    let mut given = vec![None; needs.len()];
    loop {
        let open = given.iter().filter(|g| g.is_none()).count();
        let share = (height - given.iter().flatten().sum::<f32>()) / open.max(1) as f32;
        let less = |i: &usize| given[*i].is_none() && needs[*i].is_some_and(|n| n + SLACK < share);
        match (0..needs.len()).find(less) {
            Some(i) => given[i] = needs[i].map(|n| n + SLACK),
            None => return given.into_iter().map(|g| g.unwrap_or(share)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_panel_does_not_need_is_its_neighbours() {
        assert_eq!(shares(&[None, None], 600.0), [300.0, 300.0]);
        let (short, rest) = (100.0 + SLACK, 500.0 - SLACK);
        assert_eq!(shares(&[Some(100.0), None], 600.0), [short, rest]);
        assert_eq!(shares(&[None, Some(400.0)], 600.0), [300.0, 300.0]);
        // One that could do with less than its share only once another has given.
        let shares = shares(&[Some(20.0), Some(280.0), None], 600.0);
        assert_eq!(shares[0], 20.0 + SLACK);
        assert!((shares.iter().sum::<f32>() - 600.0).abs() < 1e-3);
    }
}
