//! What was drawn last follows the document: what undo takes away redo brings back, with its other readings.

use midair_document::{Document, Kind, Object};
use midair_field::Placement;
use midair_studio::project::Project;

use crate::ghost::SEEN;
use crate::make::as_it_stands;
use crate::phase::{Draft, Last};

/// So many drawings are remembered …
const MOST: usize = 32;
/// … and of strokes no more points than this, those of all their readings counted.
const MOST_POINTS: usize = 200_000;
/// What was drawn is the same within so many metres.
const SAME: f64 = 1e-9;

impl Draft {
    /// Something was drawn just now.
    pub(crate) fn remember(&mut self, last: Last) {
        self.earlier.extend(self.last.take());
        // Ids are taken in the order of drawing: what had this one, or a later one, was undone and does not come back.
        self.earlier.retain(|l| l.id < last.id);
        let mut room = MOST_POINTS;
        let mut fits = |l: &Last| {
            let points = l.readings.iter().map(|r| points(&r.kind)).sum();
            let rest = room.checked_sub(points);
            room = rest.unwrap_or(0);
            rest.is_some()
        };
        let kept = self
            .earlier
            .iter()
            .rev()
            .take(MOST)
            .map_while(|l| Some(l).filter(|l| fits(l)));
        let dropped = self.earlier.len() - kept.count();
        self.earlier.drain(..dropped);
        self.last = Some(last);
    }
}

/// After an undo, a redo, a move or anything else that changed the document: what was drawn last of what is there now, and which
/// reading that is.
pub(crate) fn follow(project: &Project, draft: &mut Draft) {
    let document = project.document();
    let was = draft.last.as_ref().map(|l| l.id);
    draft.earlier.extend(draft.last.take());
    draft.earlier.sort_by_key(|l| l.id);
    for one in &mut draft.earlier {
        let gone = of(one, document).is_none();
        if one.gone && !gone {
            one.age = 0.0;
        } else if was != Some(one.id) {
            // Its ghosts would be in the way of what is drawn next; its readings are still to be gone through.
            one.age = one.age.max(SEEN);
        }
        one.gone = gone;
    }
    let Some(at) = draft.earlier.iter().rposition(|l| !l.gone) else {
        return;
    };
    let Some(object) = of(&draft.earlier[at], document) else {
        return;
    };
    if object.placement != Placement::IDENTITY {
        // Moved away its readings are elsewhere.
        return;
    }
    let mut last = draft.earlier.remove(at);
    let is = |kind: &Kind| as_it_stands(kind, object) == object.kind;
    // A length that was set is none of them: it stays what is spoken of.
    let chosen = last.readings.iter().position(|r| is(&r.kind));
    if let Some(chosen) = chosen.filter(|c| *c != last.chosen) {
        last.chosen = chosen;
        last.lay_out();
    }
    draft.last = Some(last);
}

/// The object that it became, where that is in the document: an id may be another's after an undo.
fn of<'a>(last: &Last, document: &'a Document) -> Option<&'a Object> {
    let object = document.object(last.id)?;
    let drawn = &last.readings.first()?.kind;
    let near = |a: &[bevy::math::DVec3], b: &[bevy::math::DVec3]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.distance(*b) < SAME)
    };
    let same = match (&object.kind, drawn) {
        (Kind::Line(a), Kind::Line(b)) => near(&a.raw, &b.raw),
        (Kind::Stroke(a), Kind::Stroke(b)) => near(&a.raw, &b.raw),
        _ => false,
    };
    same.then_some(object)
}

fn points(kind: &Kind) -> usize {
    match kind {
        Kind::Stroke(stroke) => stroke.raw.len() + 4 * stroke.segments.len(),
        _ => 2,
    }
}
