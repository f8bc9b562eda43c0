//! The outline: layers, groups, objects, as a tree.

use bevy::prelude::World;
use bevy_egui::egui::{self, Align, Key, Layout, Response, RichText, Sense, Ui};
use midair_document::{Document, GroupId, Kind, Layer, LayerId, ObjectId};

use super::{Panel, icon, kit};
use crate::command::Command;
use crate::objects::{Ask, How};
use crate::project::{Project, Selection};

/// Points to the right for each level.
const INDENT: f32 = 16.0;
const ROW: f32 = 28.0;

/// What the outline holds between frames: what is typed and what is folded.
#[derive(Default)]
pub(super) struct Outline {
    query: String,
    /// What is being renamed, and its name as it is typed.
    renaming: Option<(Node, String)>,
    folded: Vec<Node>,
}

/// One row's subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Node {
    Layer(LayerId),
    Group(GroupId),
    Object(ObjectId),
}

impl Panel for Outline {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let document = world.resource::<Project>().document();
        let selection = &world.resource::<Selection>().0;
        let mut ask = Vec::new();
        ui.horizontal(|ui| {
            let width = ui.available_width() - 44.0;
            kit::search(ui, &mut self.query, "Find", width);
            if ui
                .button(icon::STACK_PLUS)
                .on_hover_text("New layer")
                .clicked()
            {
                let name = format!("Layer {}", document.layers().count() + 1);
                ask.push(Ask::NewLayer { name });
            }
        });
        let rows = self.rows(document);
        if ui.input(|i| i.key_pressed(Key::F2))
            && let &[id] = selection.as_slice()
            && let Some(object) = document.object(id)
        {
            self.renaming = Some((Node::Object(id), object.name.clone()));
        }
        if document.is_empty() {
            ui.add_space(8.0);
            ui.weak("Nothing here yet. Place something from the library.");
        }
        egui::ScrollArea::vertical()
            .auto_shrink([false, false])
            .show_rows(ui, ROW, rows.len(), |ui, range| {
                for &(depth, node) in &rows[range] {
                    ui.push_id(node, |ui| {
                        self.row(ui, document, selection, depth, node, &mut ask);
                    });
                }
            });
        asks.extend(ask.into_iter().map(Command::Objects));
    }
}

impl Outline {
    /// The rows that are not folded away, or all that are found, with their depths.
    fn rows(&self, document: &Document) -> Vec<(usize, Node)> {
        let query = self.query.trim().to_lowercase();
        if !query.is_empty() {
            return document
                .objects()
                .filter(|(_, o)| o.name.to_lowercase().contains(&query))
                .map(|(id, _)| (0, Node::Object(id)))
                .collect();
        }
        let mut rows = Vec::new();
        for (layer, _) in document.layers() {
            rows.push((0, Node::Layer(layer)));
            if !self.folded.contains(&Node::Layer(layer)) {
                self.children(document, layer, None, 1, &mut rows);
            }
        }
        rows
    }

    fn children(
        &self,
        document: &Document,
        layer: LayerId,
        within: Option<GroupId>,
        depth: usize,
        rows: &mut Vec<(usize, Node)>,
    ) {
        // Deeper than any hand made it: the document's check bounds the rest.
        if depth > 32 {
            return;
        }
        for (id, _) in document.groups().filter(|(_, g)| g.parent == within) {
            let here = |m: &ObjectId| document.object(*m).is_some_and(|o| o.layer == layer);
            let members = document.members(id);
            // A group is listed on each layer it has something on; an empty one on the base layer.
            let homeless = members.is_empty() && layer == LayerId::BASE;
            if !homeless && !members.iter().any(here) {
                continue;
            }
            rows.push((depth, Node::Group(id)));
            if !self.folded.contains(&Node::Group(id)) {
                self.children(document, layer, Some(id), depth + 1, rows);
            }
        }
        let objects = document.objects();
        let here = objects.filter(|(_, o)| o.layer == layer && o.group == within);
        rows.extend(here.map(|(id, _)| (depth, Node::Object(id))));
    }

    fn row(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        selection: &[ObjectId],
        depth: usize,
        node: Node,
        ask: &mut Vec<Ask>,
    ) {
        let Some(view) = View::of(document, node) else {
            return;
        };
        ui.horizontal(|ui| {
            ui.set_height(ROW - ui.spacing().item_spacing.y);
            ui.add_space(INDENT * depth as f32);
            if !matches!(node, Node::Object(_)) {
                self.fold(ui, node);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.switches(ui, document, node, &view, ask);
                ui.with_layout(
                    Layout::left_to_right(Align::Center)
                        .with_main_align(Align::LEFT)
                        .with_main_justify(true),
                    |ui| {
                        if !self.rename(ui, node, ask) {
                            self.name(ui, document, selection, node, &view, ask);
                        }
                    },
                );
            });
        });
    }

    fn fold(&mut self, ui: &mut Ui, node: Node) {
        let at = self.folded.iter().position(|n| *n == node);
        let caret = if at.is_some() {
            icon::CARET_RIGHT
        } else {
            icon::CARET_DOWN
        };
        let fold = ui
            .add(egui::Button::new(caret).frame(false))
            .on_hover_text("Fold or unfold");
        if fold.clicked() {
            match at {
                Some(at) => {
                    self.folded.swap_remove(at);
                }
                None => self.folded.push(node),
            }
        }
    }

    /// The eye and the lock, and for a layer its bin.
    fn switches(
        &self,
        ui: &mut Ui,
        document: &Document,
        node: Node,
        view: &View,
        ask: &mut Vec<Ask>,
    ) {
        let switch = |ui: &mut Ui, on: bool, signs: [&str; 2], hover: [&str; 2]| {
            let text = RichText::new(signs[usize::from(on)]);
            let text = if on { text } else { text.weak() };
            ui.add(egui::Button::new(text).frame(false))
                .on_hover_text(hover[usize::from(on)])
                .clicked()
        };
        let lock = switch(
            ui,
            view.locked,
            [icon::LOCK_SIMPLE_OPEN, icon::LOCK_SIMPLE],
            ["Lock", "Unlock"],
        );
        let eye = switch(
            ui,
            view.visible,
            [icon::EYE_SLASH, icon::EYE],
            ["Show", "Hide"],
        );
        match node {
            Node::Layer(id) => {
                if let Some(layer) = document.layer(id).filter(|_| lock || eye) {
                    let layer = Layer {
                        visible: layer.visible != eye,
                        locked: layer.locked != lock,
                        ..layer.clone()
                    };
                    ask.push(Ask::ChangeLayer { id, layer });
                }
                if id != LayerId::BASE {
                    let bin = ui.add(egui::Button::new(icon::TRASH_SIMPLE).frame(false));
                    if bin
                        .on_hover_text("Delete the layer; its objects stay")
                        .clicked()
                    {
                        ask.push(Ask::RemoveLayer { id });
                    }
                }
            }
            Node::Group(_) | Node::Object(_) => {
                let ids = || match node {
                    Node::Group(id) => document.members(id),
                    Node::Object(id) => vec![id],
                    Node::Layer(_) => Vec::new(),
                };
                if lock {
                    ask.push(Ask::Locked {
                        ids: ids(),
                        locked: !view.locked,
                    });
                }
                if eye {
                    ask.push(Ask::Visible {
                        ids: ids(),
                        visible: !view.visible,
                    });
                }
            }
        }
    }

    /// The field in place of the name; says whether it is there.
    fn rename(&mut self, ui: &mut Ui, node: Node, ask: &mut Vec<Ask>) -> bool {
        let Some((_, name)) = self.renaming.as_mut().filter(|(n, _)| *n == node) else {
            return false;
        };
        let field = ui.add(egui::TextEdit::singleline(name).desired_width(f32::INFINITY));
        if !field.has_focus() && !field.lost_focus() {
            field.request_focus();
        }
        if field.lost_focus() {
            let name = std::mem::take(name);
            if !ui.input(|i| i.key_pressed(Key::Escape)) {
                match node {
                    Node::Object(id) => ask.push(Ask::Rename { id, name }),
                    Node::Group(id) => ask.push(Ask::RenameGroup { id, name }),
                    Node::Layer(id) => ask.push(Ask::ChangeLayer {
                        id,
                        layer: Layer::new(name),
                    }),
                }
            }
            self.renaming = None;
        }
        true
    }

    fn name(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        selection: &[ObjectId],
        node: Node,
        view: &View,
        ask: &mut Vec<Ask>,
    ) {
        let chosen = match node {
            Node::Object(id) => selection.contains(&id),
            Node::Group(id) => {
                let members = document.members(id);
                !members.is_empty() && members.iter().all(|m| selection.contains(m))
            }
            Node::Layer(_) => false,
        };
        let text = RichText::new(format!("{}  {}", view.sign, view.name));
        let text = if view.visible { text } else { text.weak() };
        let label = egui::Button::selectable(chosen, text)
            .truncate()
            .sense(Sense::click_and_drag());
        let row = ui.add(label);
        self.drop_here(&row, document, node, ask);
        match node {
            Node::Object(id) => {
                row.dnd_set_drag_payload(id);
            }
            Node::Group(id) => {
                if let Some(&first) = document.members(id).first() {
                    row.dnd_set_drag_payload(first);
                }
            }
            Node::Layer(_) => {}
        }
        if row.double_clicked() {
            self.renaming = Some((node, view.name.clone()));
        } else if row.clicked() {
            let (ctrl, shift) = ui.input(|i| (i.modifiers.command, i.modifiers.shift));
            let how = if ctrl || shift { How::Toggle } else { How::Set };
            let ids = match node {
                Node::Object(id) => vec![id],
                Node::Group(id) => document.members(id),
                Node::Layer(layer) => {
                    let on = document.objects().filter(|(_, o)| o.layer == layer);
                    on.map(|(id, _)| id).collect()
                }
            };
            ask.push(Ask::Select { ids, how });
        }
    }

    /// What is dragged onto a row goes where the row is.
    fn drop_here(&self, row: &Response, document: &Document, node: Node, ask: &mut Vec<Ask>) {
        let Some(dragged) = row.dnd_release_payload::<ObjectId>() else {
            return;
        };
        let ids = crate::objects::picked(document, *dragged);
        match node {
            Node::Layer(layer) => {
                ask.push(Ask::OnLayer {
                    ids: ids.clone(),
                    layer,
                });
            }
            Node::Group(group) => ask.push(Ask::Into {
                ids: vec![*dragged],
                group: Some(group),
            }),
            Node::Object(id) => ask.push(Ask::Into {
                ids: vec![*dragged],
                group: document.object(id).and_then(|o| o.group),
            }),
        }
    }
}

/// What a row shows.
struct View {
    name: String,
    sign: &'static str,
    visible: bool,
    locked: bool,
}

impl View {
    fn of(document: &Document, node: Node) -> Option<Self> {
        Some(match node {
            Node::Layer(id) => {
                let layer = document.layer(id)?;
                Self {
                    name: layer.name.clone(),
                    sign: icon::STACK,
                    visible: layer.visible,
                    locked: layer.locked,
                }
            }
            Node::Group(id) => {
                let members = document.members(id);
                let all = |f: fn(&midair_document::Object) -> bool| {
                    members.iter().filter_map(|&m| document.object(m)).all(f)
                };
                Self {
                    name: document.group(id)?.name.clone(),
                    sign: icon::FOLDER_SIMPLE,
                    visible: !all(|o| !o.visible) || members.is_empty(),
                    locked: !members.is_empty() && all(|o| o.locked),
                }
            }
            Node::Object(id) => {
                let object = document.object(id)?;
                Self {
                    name: object.name.clone(),
                    sign: match object.kind {
                        Kind::Solid(_) => icon::CUBE,
                        Kind::Foreign { .. } => icon::PUZZLE_PIECE,
                        Kind::Line(_) => icon::LINE_SEGMENT,
                        Kind::Stroke(_) => icon::SCRIBBLE,
                        Kind::Sheet(_) => icon::WAVES,
                        Kind::Reference(_) => icon::IMAGE,
                    },
                    visible: object.visible,
                    locked: object.locked,
                }
            }
        })
    }
}
