//! From swept curves to edits of the document.

use bevy::prelude::*;
use bevy::tasks::{AsyncComputeTaskPool, Task, futures::check_ready};
use midair_document::{Edit, Kind, Link, Object, ObjectId};
use midair_field::{Node, Placement, Recipe};
use midair_studio::{
    evaluate::{Evaluations, Key},
    notice::Notices,
    project::{Project, Shelf},
    settings::{SweepItem, SweepSettings, SweepShape},
};
use midair_swept::{MAX_COUNT, Profile, Rib, Row, Sweep, SweepError, moved, smoothed, touches};

use crate::act::ALPHA;

/// What a sweep is to become in the document.
pub(crate) struct Made {
    pub object: ObjectId,
    pub name: String,
    pub step: String,
    pub edits: Vec<Edit>,
    /// To be looked at for where it touches itself.
    pub sweep: Option<Sweep>,
}

/// What is said of a clone that is nothing.
pub(crate) const EMPTY: &str = "What is to be cloned is empty. Choose something else in the panel.";

/// Surfaces are checked for lying flat with so many points only: enough for that.
const FEW: usize = 24;

/// The edits that make what was swept.
///
/// # Errors
/// One line saying why nothing can be made of it.
pub(crate) fn make(
    ribs: &[Rib],
    onto: Option<ObjectId>,
    links: Vec<Link>,
    settings: &SweepSettings,
    project: &Project,
    shelf: &Shelf,
    evaluations: &Evaluations,
) -> Result<Made, String> {
    let document = project.document();
    if let Some(id) = onto
        && let Some(object) = document.object(id)
        && let Some(before) = object.sweep()
    {
        let sweep = Sweep {
            ribs: joined(&before.ribs, ribs, &object.placement).into(),
            ..before.clone()
        };
        let kind = kind_of(&sweep)?;
        return Ok(Made {
            object: id,
            name: object.name.clone(),
            step: format!("Extend {}", object.name),
            edits: vec![Edit::SetKind { id, kind }],
            sweep: Some(sweep),
        });
    }
    let id = ObjectId(document.next_id());
    let (name, object, sweep) = if settings.shape == SweepShape::Clones {
        let (recipe, at) = row(ribs, settings, project, shelf, evaluations)?;
        let object = Object::solid(format!("Clones {}", id.0), recipe);
        (
            format!("Clones {}", id.0),
            object.placed(Placement::at(at)),
            None,
        )
    } else {
        let tube = settings.shape == SweepShape::Tube;
        let sweep = Sweep {
            ribs: smoothed(ribs, ALPHA, settings.smooth as usize),
            count: settings.count.clamp(2, MAX_COUNT),
            profile: if tube { Profile::Tube } else { Profile::Sheet },
            thickness: if tube && settings.caps {
                0.0
            } else {
                settings.thickness.max(0.0)
            },
            caps: tube && settings.caps,
        };
        sweep.validate().map_err(|e| said(&e))?;
        let at = sweep.bounds().centre();
        let sweep = Sweep {
            ribs: moved(&sweep.ribs, -at),
            ..sweep
        };
        let name = format!("{} {}", name_of(&sweep), id.0);
        let object = Object::new(name.clone(), kind_of(&sweep)?).placed(Placement::at(at));
        (name, object, Some(sweep))
    };
    let object = Object { links, ..object };
    Ok(Made {
        object: id,
        step: format!("Sweep {name}"),
        edits: vec![Edit::Add {
            id,
            object: object.into(),
        }],
        name,
        sweep,
    })
}

/// What people call it.
fn name_of(sweep: &Sweep) -> &'static str {
    match (sweep.profile, sweep.is_closed()) {
        (Profile::Sheet, false) => "Surface",
        (Profile::Sheet, true) => "Plate",
        (Profile::Tube, _) if sweep.caps => "Tube",
        (Profile::Tube, true) => "Pipe",
        (Profile::Tube, false) => "Open tube",
    }
}

/// Why, as a person is told.
pub(crate) fn said(error: &SweepError) -> String {
    format!("Nothing was made of the sweep: {error}.")
}

/// A solid where it is closed, else a surface.
///
/// # Errors
/// One line saying why it is neither.
pub(crate) fn kind_of(sweep: &Sweep) -> Result<Kind, String> {
    sweep.validate().map_err(|e| said(&e))?;
    if sweep.ribs.iter().all(Rib::is_point) {
        return Err(said(&SweepError::OnePoint));
    }
    let every = sweep.ribs.len().div_ceil(FEW).max(1);
    let mut few: Vec<Rib> = sweep.ribs.iter().step_by(every).copied().collect();
    few.extend(sweep.ribs.last());
    let few = Sweep {
        ribs: few.into(),
        count: sweep.count.min(FEW as u32),
        ..sweep.clone()
    };
    // A tenth of a millimetre is thick enough to tell whether there is any area at all.
    let plate = Sweep {
        thickness: if few.is_closed() {
            few.thickness
        } else {
            1.0e-4
        },
        ..few
    };
    plate.solid().map_err(|e| said(&e))?;
    let recipe = Recipe::new(Node::Sweep(sweep.clone()));
    Ok(if sweep.is_closed() {
        Kind::Solid(recipe)
    } else {
        Kind::Sheet(recipe)
    })
}

/// New curves at the end of those that are there that is nearer, all in the frame of the object.
fn joined(before: &[Rib], new: &[Rib], placement: &Placement) -> Vec<Rib> {
    let back = placement.affine().inverse();
    let turn = placement.rotation.inverse();
    let own = |r: &Rib| Rib {
        points: r.points.map(|p| back.transform_point3(p)),
        tangents: r.tangents.map(|m| back.transform_vector3(m)),
        start: (turn * r.start).normalize(),
        ..*r
    };
    let new: Vec<Rib> = new.iter().map(own).collect();
    let (Some(first), Some(last), Some(start)) = (before.first(), before.last(), new.first())
    else {
        return before.to_vec();
    };
    if first.apart(start, 16) < last.apart(start, 16) {
        new.into_iter()
            .rev()
            .chain(before.iter().copied())
            .collect()
    } else {
        before.iter().copied().chain(new).collect()
    }
}

/// A row of clones, and where its own origin stands.
fn row(
    ribs: &[Rib],
    settings: &SweepSettings,
    project: &Project,
    shelf: &Shelf,
    evaluations: &Evaluations,
) -> Result<(Recipe, Vec3), String> {
    let (item, longest) = item(settings, project, shelf)?;
    // The curve that hung there had it made.
    let made = evaluations.made(&Key::new(&item, project.document().step()));
    if made.is_some_and(|m| m.mesh.triangles.is_empty()) {
        return Err(EMPTY.to_owned());
    }
    let ribs: Vec<Rib> = if settings.spread {
        thinned(ribs, settings.clones)
    } else {
        ribs.last().copied().into_iter().collect()
    };
    let row = Row {
        ribs: ribs.into(),
        count: settings.clones.max(1),
        size: settings.clone_size / longest,
        paced: settings.paced,
    };
    row.validate().map_err(|e| said(&e))?;
    let each = row.places();
    let sum = each.iter().map(|p| p.translation).sum::<Vec3>();
    let at = sum / each.len().max(1) as f32;
    let row = Row {
        ribs: moved(&row.ribs, -at),
        ..row
    };
    Ok((Recipe::new(Node::Clones { row, recipe: item }), at))
}

/// Curves that lie as far apart as the clones along one of them do.
fn thinned(ribs: &[Rib], clones: u32) -> Vec<Rib> {
    let mut kept: Vec<Rib> = Vec::new();
    for rib in ribs {
        let gap = rib.curve().length() as f32 / clones.saturating_sub(1).max(1) as f32;
        if kept.last().is_none_or(|last| last.apart(rib, 16) >= gap) {
            kept.push(*rib);
        }
    }
    kept
}

/// What is cloned, and its longest side in metres.
///
/// # Errors
/// One line saying what is missing.
pub(crate) fn item(
    settings: &SweepSettings,
    project: &Project,
    shelf: &Shelf,
) -> Result<(Recipe, f32), String> {
    let recipe = match &settings.item {
        SweepItem::Component(id) => {
            let found = shelf.library.get(id);
            let found = found.filter(|c| !c.missing).ok_or_else(|| {
                format!(
                    "The library has no component \"{id}\" to clone. Choose another in the panel."
                )
            })?;
            found.placed()
        }
        SweepItem::Object(id) => {
            let object = project.document().object(ObjectId(*id));
            let object = object.ok_or_else(|| {
                format!("Object {id} is gone and cannot be cloned. Choose another in the panel.")
            })?;
            object.operand().ok_or_else(|| {
                format!(
                    "{} is open and cannot be cloned. Give it a thickness first.",
                    object.name
                )
            })?
        }
    };
    let size = recipe.bounds();
    let longest = if size.is_empty() {
        0.0
    } else {
        size.size().max_element()
    };
    if longest > 0.0 && longest.is_finite() {
        Ok((recipe, longest))
    } else {
        Err(EMPTY.to_owned())
    }
}

/// Sweeps that are being looked at for where they touch themselves.
#[derive(Resource, Default)]
pub(crate) struct Looks(Vec<Task<Option<String>>>);

/// More triangles than this are not looked at.
const MOST: usize = 400_000;

impl Looks {
    /// Looks at a solid off the frame.
    pub fn look(&mut self, name: String, sweep: Option<Sweep>) {
        let Some(sweep) = sweep.filter(Sweep::is_closed) else {
            return;
        };
        let pool = AsyncComputeTaskPool::get();
        self.0
            .push(pool.spawn(async move { touching(&name, &sweep) }));
    }
}

fn touching(name: &str, sweep: &Sweep) -> Option<String> {
    let solid = sweep.solid().ok()?;
    if let Some(at) = solid.crossed {
        return Some(format!(
            "The profile of {name} crosses itself at {:.2}, {:.2}, {:.2} m of its own: all its loops count as inside.",
            at.x, at.y, at.z
        ));
    }
    if solid.mesh.triangles.len() > MOST {
        return None;
    }
    let (pairs, places) = touches(&solid.mesh);
    let at = places.first().or(solid.inverted.first())?;
    let more = if pairs > 1 { " and elsewhere" } else { "" };
    Some(format!(
        "{name} runs through itself at {:.2}, {:.2}, {:.2} m of its own{more}. What is inside counts as inside; smooth it or sweep it wider to part it.",
        at.x, at.y, at.z
    ))
}

/// Says what was found.
pub(crate) fn tell(mut looks: ResMut<Looks>, mut notices: ResMut<Notices>) {
    if looks.0.is_empty() {
        return;
    }
    looks.0.retain_mut(|task| match check_ready(task) {
        Some(found) => {
            if let Some(line) = found {
                notices.info(line);
            }
            false
        }
        None => true,
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rib(z: f32) -> Rib {
        Rib {
            points: [Vec3::new(-0.1, 0.0, z), Vec3::new(0.1, 0.0, z)],
            tangents: [Vec3::new(0.1, 0.2, 0.0), Vec3::new(0.1, -0.2, 0.0)],
            slopes: [1.0; 2],
            start: Quat::IDENTITY,
            twist: 0.0,
        }
    }

    #[test]
    fn new_curves_join_the_end_that_is_nearer() {
        let before: Vec<Rib> = (0..5).map(|i| rib(0.01 * i as f32)).collect();
        let placement = Placement::at(Vec3::Y);
        let new = |from: f32| -> Vec<Rib> {
            (1..4)
                .map(|i| rib(from * 0.01 * i as f32).shifted(Vec3::Y))
                .collect()
        };
        let after = joined(&before, &new(2.0), &placement);
        assert_eq!(after[..5], before[..]);
        assert!((after[7].points[0].z - 0.06).abs() < 1e-6 && after[7].points[0].y.abs() < 1e-6);
        let ahead = joined(&before, &new(-2.0), &placement);
        assert!((ahead[0].points[0].z + 0.06).abs() < 1e-6);
        assert_eq!(ahead[3..], before[..]);
    }

    #[test]
    fn what_is_closed_is_a_solid_and_what_lies_in_a_line_is_nothing() {
        let sheet = Sweep {
            ribs: (0..9).map(|i| rib(0.01 * i as f32)).collect(),
            count: 48,
            profile: Profile::Sheet,
            thickness: 0.0,
            caps: false,
        };
        assert!(matches!(kind_of(&sheet), Ok(Kind::Sheet(_))));
        let plate = Sweep {
            thickness: 0.01,
            ..sheet.clone()
        };
        assert!(matches!(kind_of(&plate), Ok(Kind::Solid(_))));
        let still = Sweep {
            ribs: vec![rib(0.0); 3].into(),
            ..sheet
        };
        assert!(kind_of(&still).unwrap_err().contains("encloses nothing"));
    }

    #[test]
    fn curves_for_clones_lie_as_far_apart_as_the_clones() {
        let ribs: Vec<Rib> = (0..100).map(|i| rib(0.01 * i as f32)).collect();
        let kept = thinned(&ribs, 5);
        assert!((10..25).contains(&kept.len()), "{}", kept.len());
    }
}
