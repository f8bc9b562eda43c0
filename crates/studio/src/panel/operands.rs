//! The operands panel: what is marked, or what a selected solid was made from, in the order in which it
//! is read.

use bevy::prelude::World;
use bevy_egui::egui::{self, Key, RichText, Ui};
use egui_dnd::utils::shift_vec;
use midair_document::{Document, ObjectId};
use midair_field::{Node, Op};

use super::{Panel, icon};
use crate::command::Command;
use crate::operands::{Of, OperandAsk, listed, name};
use crate::project::{Project, Selection};
use crate::settings::Settings;

/// What the panel holds between frames: which solid one has gone into.
#[derive(Default)]
pub(super) struct Operands {
    within: Option<(ObjectId, Vec<usize>)>,
}

/// What one row shows.
struct Row {
    name: String,
    op: Op,
    muted: bool,
    /// Has operands of its own.
    nested: bool,
}

impl Panel for Operands {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let document = world.resource::<Project>().document();
        let selection = &world.resource::<Selection>().0;
        preview(ui, world, asks);
        ui.separator();
        let marked = marked(document);
        if !marked.is_empty() {
            ui.strong("Marked");
            rows(ui, None, &[], &marked, asks);
            ui.separator();
        }
        let solid = selection.iter().find_map(|&id| {
            let object = document.object(id)?;
            listed(object.recipe()?, &[]).map(|_| (id, object))
        });
        let Some((id, object)) = solid else {
            self.within = None;
            if marked.is_empty() {
                ui.weak("Mark two objects or more, or select a solid that was made from some.");
            }
            return;
        };
        let mut path = match self.within.take() {
            Some((of, path)) if of == id => path,
            _ => Vec::new(),
        };
        let Some(recipe) = object.recipe() else {
            return;
        };
        // An undo may have taken away where one was.
        while listed(recipe, &path).is_none() && path.pop().is_some() {}
        ui.horizontal_wrapped(|ui| {
            if ui.selectable_label(path.is_empty(), &object.name).clicked() {
                path.clear();
            }
            for depth in 0..path.len() {
                ui.label(icon::CARET_RIGHT);
                let around = listed(recipe, &path[..depth]).and_then(|l| l.get(path[depth]));
                let label = around.map_or_else(String::new, |o| name(&o.recipe, path[depth]));
                if ui
                    .selectable_label(depth + 1 == path.len(), label)
                    .clicked()
                {
                    path.truncate(depth + 1);
                    break;
                }
            }
        });
        let list: Vec<Row> = listed(recipe, &path)
            .unwrap_or_default()
            .iter()
            .enumerate()
            .map(|(i, o)| Row {
                name: name(&o.recipe, i),
                op: o.op,
                muted: o.muted,
                nested: matches!(o.recipe.node(), Node::Solid(_)),
            })
            .collect();
        if let Some(into) = rows(ui, Some(id), &path, &list, asks) {
            path.push(into);
        }
        if path.is_empty() {
            let unfuse = ui
                .button(format!("{}  Unfuse", icon::ARROWS_OUT))
                .on_hover_text("All operands become objects again, marked as they were");
            if unfuse.clicked() {
                asks.push(Command::Operand(OperandAsk::Unfuse { object: id }));
            }
        }
        self.within = Some((id, path));
    }
}

fn preview(ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
    let on = world.resource::<Settings>().preview.on;
    let button = ui
        .selectable_label(on, format!("{}  Preview", icon::EYE))
        .on_hover_text("Show what the marked operands come to before they are fused");
    if button.clicked() {
        asks.push(Settings::command("preview.on", !on));
    }
}

fn marked(document: &Document) -> Vec<Row> {
    let row = |&(id, op): &(ObjectId, Op)| Row {
        name: document.object(id).map_or("?", |o| &o.name).to_owned(),
        op,
        muted: false,
        nested: false,
    };
    document.pending().iter().map(row).collect()
}

/// One list; gives the row that one went into.
fn rows(
    ui: &mut Ui,
    object: Option<ObjectId>,
    path: &[usize],
    list: &[Row],
    asks: &mut Vec<Command>,
) -> Option<usize> {
    let mut into = None;
    let of = |at: usize| Of {
        object,
        path: path.iter().copied().chain([at]).collect(),
    };
    let base = list.iter().position(|r| !r.muted);
    let drag =
        egui_dnd::dnd(ui, ("operands", object, path)).show(0..list.len(), |ui, at, handle, _| {
            let row = &list[at];
            ui.push_id(at, |ui| {
                ui.horizontal(|ui| {
                    handle.ui(ui, |ui| {
                        ui.label(icon::DOTS_SIX_VERTICAL);
                    });
                    let mut ask = |a: OperandAsk| asks.push(Command::Operand(a));
                    if base == Some(at) {
                        ui.add_enabled(false, egui::Button::new(icon::CUBE))
                            .on_disabled_hover_text("What the others join");
                    } else if let Some(op) = sign(ui, row.op) {
                        ask(OperandAsk::Join { of: of(at), op });
                    }
                    let text = RichText::new(&row.name);
                    let text = if row.muted {
                        text.weak().strikethrough()
                    } else {
                        text
                    };
                    let label = ui.add(egui::Button::new(text).frame(false).truncate());
                    if label.clicked() {
                        label.request_focus();
                    }
                    if label.has_focus() {
                        let (up, down) = ui.input_mut(|i| {
                            (
                                i.consume_key(egui::Modifiers::ALT, Key::ArrowUp),
                                i.consume_key(egui::Modifiers::ALT, Key::ArrowDown),
                            )
                        });
                        if up && at > 0 {
                            ask(OperandAsk::Move {
                                of: of(at),
                                to: at - 1,
                            });
                        }
                        if down && at + 1 < list.len() {
                            ask(OperandAsk::Move {
                                of: of(at),
                                to: at + 1,
                            });
                        }
                    }
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        if tool(ui, icon::TRASH, "Remove") {
                            ask(OperandAsk::Remove { of: of(at) });
                        }
                        if object.is_none() {
                            return;
                        }
                        if tool(ui, icon::ARROW_SQUARE_OUT, "Take out: an object again") {
                            ask(OperandAsk::TakeOut { of: of(at) });
                        }
                        let (eye, what) = if row.muted {
                            (icon::EYE_SLASH, "Let it take part again")
                        } else {
                            (icon::EYE, "Mute: keep it, but leave it out")
                        };
                        if tool(ui, eye, what) {
                            let muted = !row.muted;
                            ask(OperandAsk::Mute { of: of(at), muted });
                        }
                        if row.nested && tool(ui, icon::CARET_RIGHT, "What it was made from") {
                            into = Some(at);
                        }
                    });
                });
            });
        });
    if let Some(moved) = drag.final_update() {
        let mut order: Vec<usize> = (0..list.len()).collect();
        shift_vec(moved.from, moved.to, &mut order);
        if let Some(to) = order.iter().position(|&o| o == moved.from)
            && to != moved.from
        {
            let of = of(moved.from);
            asks.push(Command::Operand(OperandAsk::Move { of, to }));
        }
    }
    into
}

fn tool(ui: &mut Ui, sign: &str, what: &str) -> bool {
    ui.button(sign).on_hover_text(what).clicked()
}

/// A button that shows how an operand joins; gives how it is to join instead.
fn sign(ui: &mut Ui, op: Op) -> Option<Op> {
    let all = [
        (Op::Union, icon::UNITE, "Unite"),
        (Op::Intersect, icon::INTERSECT, "Intersect"),
        (Op::Subtract, icon::SUBTRACT, "Subtract"),
    ];
    let now = all.iter().find(|a| a.0 == op).map_or("", |a| a.1);
    let mut chosen = None;
    ui.menu_button(now, |ui| {
        for (other, sign, what) in all {
            let row = ui.selectable_label(other == op, format!("{sign}  {what}"));
            if row.clicked() {
                chosen = Some(other).filter(|&o| o != op);
                ui.close();
            }
        }
    });
    chosen
}
