use std::collections::HashSet;

use crate::recipes::{check_recipe, check_sheet, is_box};
use crate::{Document, GroupId, Kind, LayerId, MeshStore, ObjectId};

impl Document {
    /// What is wrong with the document, one line each; nothing for a sound one.
    pub fn check(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut fault = |line: String| faults.push(line);
        let (least, most) = Self::STEPS;
        if !(least..=most).contains(&self.step) {
            fault(format!(
                "the step {} m is not in {least} to {most}",
                self.step
            ));
        }
        if !self.layers.contains_key(&LayerId::BASE) {
            fault("the base layer is missing".into());
        }
        let mut sound = HashSet::new();
        let mut ids = HashSet::new();
        let all = (self.objects.keys().map(|id| id.0))
            .chain(self.layers.keys().map(|id| id.0))
            .chain(self.groups.keys().map(|id| id.0));
        for id in all {
            if id >= self.next_id {
                fault(format!("id {id} was never handed out"));
            }
            if !ids.insert(id) {
                fault(format!("id {id} is used twice"));
            }
        }
        for (id, group) in self.groups() {
            match group.parent {
                Some(p) if self.group(p).is_none() => {
                    fault(format!(
                        "group {id} lies in group {p}, which does not exist"
                    ));
                }
                parent if self.groups_above(parent).any(|g| g == id) => {
                    fault(format!("group {id} lies inside itself"));
                }
                _ => {}
            }
        }
        for (id, object) in self.objects() {
            let who = format!("object {id} (\"{}\")", one_line(&object.name));
            if !object.placement.is_sound() {
                fault(format!(
                    "{who} stands nowhere: its placement is not finite, or a scale is zero"
                ));
            }
            if self.layer(object.layer).is_none() {
                fault(format!(
                    "{who} lies on layer {}, which does not exist",
                    object.layer
                ));
            }
            if let Some(g) = object.group.filter(|&g: &GroupId| self.group(g).is_none()) {
                fault(format!("{who} lies in group {g}, which does not exist"));
            }
            match &object.kind {
                Kind::Solid(recipe) => {
                    if let Err(e) = check_recipe(recipe, &mut sound) {
                        fault(format!("{who} is no solid: {e}"));
                    }
                }
                Kind::Foreign { bounds, .. } if !is_box(bounds) => {
                    fault(format!("{who} has a box that is not finite"));
                }
                Kind::Reference(reference) if !reference.is_sound() => {
                    fault(format!(
                        "{who} is no picture: its size or its opacity is out of bounds"
                    ));
                }
                Kind::Foreign { .. } | Kind::Reference(_) => {}
                Kind::Line(line) => {
                    if let Err(e) = line.check() {
                        fault(format!("{who} is no line: {e}"));
                    }
                }
                Kind::Stroke(stroke) => {
                    if let Err(e) = stroke.check() {
                        fault(format!("{who} is no stroke: {e}"));
                    }
                }
                Kind::Sheet(recipe) => {
                    if let Err(e) = check_sheet(recipe) {
                        fault(format!("{who} is no surface: {e}"));
                    }
                }
            }
        }
        let mut marked = HashSet::new();
        for &(id, _) in self.pending() {
            if self.object(id).is_none() {
                fault(format!("object {id} is marked, but does not exist"));
            }
            if !marked.insert(id) {
                fault(format!("object {id} is marked twice"));
            }
        }
        faults
    }

    /// The objects that need a mesh or a picture the store does not hold, one line each.
    pub fn check_meshes(&self, store: &MeshStore) -> Vec<String> {
        self.objects()
            .filter_map(|(id, object)| {
                if let Some(reference) = object.reference() {
                    let name = one_line(&object.name);
                    let lost = store.image(reference.image).is_none();
                    return lost.then(|| format!("object {id} (\"{name}\") lacks its picture"));
                }
                let lost = self.lost_meshes(id, store);
                (lost > 0).then(|| {
                    let s = if lost == 1 { "" } else { "es" };
                    let name = one_line(&object.name);
                    format!("object {id} (\"{name}\") lacks {lost} mesh{s}")
                })
            })
            .collect()
    }

    fn lost_meshes(&self, id: ObjectId, store: &MeshStore) -> usize {
        let mut meshes = Default::default();
        if let Some(object) = self.object(id) {
            crate::document::meshes_of(&object.kind, &mut HashSet::new(), &mut meshes);
        }
        meshes.iter().filter(|&&m| store.get(m).is_none()).count()
    }
}

/// Text from a file as part of a message of one line.
pub(crate) fn one_line(text: &str) -> String {
    let mut line: String = text
        .chars()
        .take(200)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.chars().nth(200).is_some() {
        line.push('…');
    }
    line
}
