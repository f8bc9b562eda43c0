//! The ruler: how far it is between two points, and how large what is selected is.

use bevy::prelude::*;
use midair_document::Object;
use serde::{Deserialize, Serialize};

use crate::StudioSet;
use crate::command::Command;
use crate::evaluate::{Evaluations, Key};
use crate::project::{Project, Selection};
use crate::settings::Settings;
use crate::show::{Drafts, Readouts, display_steps};
use crate::snap::{box_of, own_box};
use crate::units::{length, size};

/// The ruler in hand.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Ruler {
    /// Whether points are being picked.
    pub on: bool,
    /// Where the next point would be.
    pub pointed: Option<Vec3>,
    points: Vec<Vec3>,
}

impl Ruler {
    /// The two points, as far as they are picked; in place of the second one where the pointer is.
    pub fn ends(&self) -> Option<(Vec3, Vec3)> {
        let first = *self.points.first()?;
        let second = self.points.get(1).copied();
        second
            .or(self.pointed.filter(|_| self.on))
            .map(|second| (first, second))
    }

    /// Its points.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    fn carry_out(&mut self, ask: MeasureAsk) {
        match ask {
            MeasureAsk::Begin => {
                self.on = true;
                self.points.clear();
            }
            MeasureAsk::Point(point) if point.is_finite() => {
                // A third point begins another measure.
                if self.points.len() > 1 {
                    self.points.clear();
                }
                self.points.push(point);
            }
            MeasureAsk::Point(_) => {}
            MeasureAsk::End => *self = Self::default(),
        }
    }
}

/// What can be asked of the ruler.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MeasureAsk {
    /// It is taken in hand: the next points are its ends.
    Begin,
    /// One of its ends, in world metres.
    Point(Vec3),
    /// It is put away.
    End,
}

/// The box in the world of what is selected, as it stands in the hands.
pub fn selected_box(
    project: &Project,
    selection: &Selection,
    drafts: &Drafts,
) -> Option<(Vec3, Vec3)> {
    box_of_all(project, selection, drafts, |object| {
        own_box(project, object)
    })
}

/// The box in the world of what is selected, from that of each in its own frame.
fn box_of_all(
    project: &Project,
    selection: &Selection,
    drafts: &Drafts,
    own: impl Fn(&Object) -> Option<(Vec3, Vec3)>,
) -> Option<(Vec3, Vec3)> {
    let boxes = selection.0.iter().filter_map(|&id| {
        let object = project.document().object(id)?;
        let placement = drafts.get(id).unwrap_or(&object.placement);
        Some(box_of(placement, own(object)?))
    });
    boxes.reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Ruler>()
        .add_systems(Update, ask.in_set(StudioSet::Ask))
        .add_systems(Update, say.in_set(StudioSet::Cue));
}

fn ask(mut commands: MessageReader<Command>, mut ruler: ResMut<Ruler>) {
    for command in commands.read() {
        match command {
            Command::Measure(ask) => ruler.carry_out(*ask),
            Command::New | Command::Open(_) => {
                ruler.set_if_neq(Ruler::default());
            }
            _ => {}
        }
    }
}

/// The box of what was made of an object, in its own frame: where that lies further in than what its recipe could fill,
/// as where something is cut off or a brush's reach is empty.
fn made_box(project: &Project, evaluations: &Evaluations, object: &Object) -> Option<(Vec3, Vec3)> {
    let (low, high) = own_box(project, object)?;
    let document = project.document();
    let made = object.recipe().and_then(|recipe| {
        let steps = display_steps(document, object, recipe).into_iter();
        let mut keys = steps.map(|step| Key::new(recipe, step));
        keys.find_map(|key| {
            // Of a row one clone is made, which says nothing of how far it goes.
            let made = evaluations.made(&key).filter(|m| m.places.is_none())?;
            Some((key.step(), made.bounds))
        })
    });
    let Some((step, made)) = made.filter(|(_, made)| !made.is_empty()) else {
        return Some((low, high));
    };
    // A surface that is made of facets lies a little within its shape: that is no other size.
    let in_by = |by: Vec3| by.cmpgt(Vec3::splat(step));
    Some((
        Vec3::select(in_by(made.min - low), made.min, low),
        Vec3::select(in_by(high - made.max), made.max, high),
    ))
}

fn say(
    (project, evaluations): (Res<Project>, Res<Evaluations>),
    selection: Res<Selection>,
    drafts: Res<Drafts>,
    ruler: Res<Ruler>,
    settings: Res<Settings>,
    mut readouts: ResMut<Readouts>,
) {
    let unit = settings.units.length;
    if let Some((a, b)) = ruler.ends() {
        readouts.say(a.midpoint(b), length(a.distance(b), unit));
    }
    // As large as what is seen of it.
    let seen = |object: &Object| made_box(&project, &evaluations, object);
    if let Some((low, high)) = box_of_all(&project, &selection, &drafts, seen) {
        let foot = Vec3::new(low.x.midpoint(high.x), low.y, high.z);
        readouts.say(foot, size(high - low, unit));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_points_are_a_measure_and_a_third_begins_anew() {
        let mut ruler = Ruler::default();
        ruler.carry_out(MeasureAsk::Begin);
        assert_eq!(ruler.ends(), None);
        ruler.carry_out(MeasureAsk::Point(Vec3::X));
        ruler.pointed = Some(Vec3::Y);
        assert_eq!(ruler.ends(), Some((Vec3::X, Vec3::Y)));
        ruler.carry_out(MeasureAsk::Point(Vec3::Z));
        ruler.carry_out(MeasureAsk::Point(Vec3::NAN));
        assert_eq!(ruler.ends(), Some((Vec3::X, Vec3::Z)));
        ruler.carry_out(MeasureAsk::Point(Vec3::ONE));
        assert_eq!(ruler.points(), [Vec3::ONE]);
        ruler.carry_out(MeasureAsk::End);
        assert_eq!(ruler, Ruler::default());
    }
}
