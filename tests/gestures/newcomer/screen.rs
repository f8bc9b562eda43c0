//! What is to be read on the screen: the texts and buttons of the panels, as a screen reader has them.

use bevy_egui::{EguiContext, EguiOutput, PrimaryEguiContext};
use midair_studio::panel::egui::accesskit::{Role, Toggled};
use midair_studio::panel::egui::{Rect, pos2};

use bevy::prelude::*;

use crate::desk::Desk;

/// One text or button.
#[derive(Clone, Debug)]
pub struct Seen {
    pub role: Role,
    pub text: String,
    pub rect: Rect,
    /// A choice that is made.
    pub chosen: bool,
}

impl Seen {
    /// The text without icons and numbers beside it.
    pub fn name(&self) -> String {
        let words = self.text.split_whitespace();
        let words: Vec<_> = words
            .filter(|w| w.chars().all(|c| c.is_ascii_alphabetic() || c == '-'))
            .collect();
        words.join(" ")
    }
}

impl Desk {
    /// From here on everything that is drawn says what it is.
    pub fn open_eyes(&mut self) {
        let world = self.app.world_mut();
        let mut contexts = world.query_filtered::<&mut EguiContext, With<PrimaryEguiContext>>();
        contexts
            .single_mut(world)
            .unwrap()
            .get_mut()
            .enable_accesskit();
        self.wait(3);
    }

    /// Everything that is written.
    pub fn screen(&mut self) -> Vec<Seen> {
        let world = self.app.world_mut();
        let mut outputs = world.query_filtered::<&EguiOutput, With<PrimaryEguiContext>>();
        let output = outputs.single(world).unwrap();
        let Some(update) = &output.platform_output.accesskit_update else {
            return Vec::new();
        };
        let nodes = update.nodes.iter();
        nodes
            .filter_map(|(_, node)| {
                let text = node.label().or(node.value())?.trim().to_owned();
                let b = node.bounds()?;
                let rect = Rect::from_min_max(
                    pos2(b.x0 as f32, b.y0 as f32),
                    pos2(b.x1 as f32, b.y1 as f32),
                );
                (!text.is_empty()).then_some(Seen {
                    role: node.role(),
                    text,
                    rect,
                    chosen: node.toggled() == Some(Toggled::True),
                })
            })
            .collect()
    }

    /// The middle of the button that is called so.
    pub fn button_called(&mut self, name: &str) -> Option<Seen> {
        let all = self.screen();
        let not = [Role::Label, Role::TextInput, Role::MultilineTextInput];
        let mut buttons = all.into_iter().filter(|s| !not.contains(&s.role));
        buttons.find(|s| s.name().eq_ignore_ascii_case(name))
    }

    /// What the tutorial's card says, without its heading and buttons.
    pub fn card(&mut self) -> Option<String> {
        let all = self.screen();
        let button = |name: &str| {
            let mut buttons = all.iter().filter(|s| s.role == Role::Button);
            buttons.find(|s| s.name() == name)
        };
        if let Some(end) = all.iter().find(|s| s.text.starts_with("That is all")) {
            return Some(end.text.clone());
        }
        // The first of its buttons stands at the card's left.
        let foot = button("Back").or(button("Show me"))?.rect;
        let left = foot.left() - 4.0..foot.left() + 340.0;
        let within = |r: Rect| {
            let at = r.center();
            left.contains(&r.left()) && at.y < foot.top() && at.y > foot.top() - 240.0
        };
        let texts = all.iter().filter(|s| s.role == Role::Label);
        let mut texts: Vec<_> = texts.filter(|s| within(s.rect)).collect();
        texts.sort_by(|a, b| a.rect.top().total_cmp(&b.rect.top()));
        let title =
            |s: &Seen| s.text.contains(" of ") && s.text.contains(": ") && s.text.len() < 40;
        let said: Vec<_> = texts
            .into_iter()
            .filter(|s| !title(s))
            .map(|s| s.text.clone())
            .collect();
        Some(said.join(" "))
    }
}
