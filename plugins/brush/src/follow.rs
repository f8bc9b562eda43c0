//! Skeletons are live: a stroke that came of a drawn line or stroke follows it when it is moved or drawn otherwise, and one
//! painted with a solid that was carried in becomes what that solid becomes.

use bevy::math::{DVec3, Vec3, Vec4};
use midair_curve::Polyline;
use midair_document::{Document, Edit, Link, Object, ObjectId};
use midair_field::{Canvas, Placement, Recipe, Skeleton, Stroke};

use crate::{carry::way, easel::canvas, stroke};

/// The edits that bring the strokes of paintings after their sources. [`Link::part`] is a stroke's place
/// in its painting: where strokes before it come or go, the link goes with it. A stroke that cannot
/// follow, since nothing would be left of it, stays as it was.
pub(crate) fn follow(was: &Document, is: &Document) -> Vec<Edit> {
    let linked = is.objects().filter(|(_, o)| !o.links.is_empty());
    let mut edits = Vec::new();
    for (id, object) in linked {
        let (Some(painted), Some(before)) = (canvas(object), was.object(id)) else {
            continue;
        };
        let links = match canvas(before) {
            Some(old) if before.kind != object.kind => {
                kept(&before.links, &object.links, &old.strokes, &painted.strokes)
            }
            _ => object.links.clone(),
        };
        for link in &links {
            let at = link.part as usize;
            let sources = (was.object(link.source), is.object(link.source));
            let (Some(old), (Some(from), Some(to))) = (painted.strokes.get(at), sources) else {
                continue;
            };
            if from.kind == to.kind && from.placement == to.placement {
                continue;
            }
            let stands = [&before.placement, &object.placement];
            if let Some(next) = brought(old, painted.reach, from, to, stands)
                && next != *old
                && is_sound(&next)
            {
                edits.push(Edit::SetStrokes {
                    id,
                    at,
                    gone: 1,
                    strokes: vec![next],
                });
            }
        }
        if links != object.links {
            edits.push(Edit::SetLinks { id, links });
        }
    }
    edits
}

fn is_sound(stroke: &Stroke) -> bool {
    let alone = Canvas {
        strokes: vec![stroke.clone()],
        ..Canvas::default()
    };
    alone.validate().is_ok()
}

/// The links after strokes came, went or changed: those of strokes that are gone go, those that came in
/// the same change are right as they are.
fn kept(before: &[Link], now: &[Link], old: &[Stroke], new: &[Stroke]) -> Vec<Link> {
    let same = |a: &[Stroke], b: &[Stroke]| a.iter().zip(b).take_while(|(x, y)| x == y).count();
    let head = same(old, new);
    let most = old.len().min(new.len()) - head;
    let (old_end, new_end) = (old.iter().rev(), new.iter().rev());
    let tail = old_end.zip(new_end).take(most);
    let tail = tail.take_while(|(x, y)| x == y).count();
    let place = |part: u32| {
        let at = part as usize;
        let after = old.len() - tail;
        if at < head || (at < after && old.len() == new.len()) {
            Some(part)
        } else if at >= after {
            Some((at + new.len() - old.len()) as u32)
        } else {
            None
        }
    };
    now.iter()
        .filter_map(|link| {
            let part = if before.contains(link) {
                place(link.part)?
            } else {
                link.part
            };
            Some(Link { part, ..*link })
        })
        .collect()
}

/// The stroke after its source changed from one object to the other; its painting stood and stands so.
fn brought(
    old: &Stroke,
    reach: f32,
    from: &Object,
    to: &Object,
    [stood, stands]: [&Placement; 2],
) -> Option<Stroke> {
    if let Skeleton::Volume(recipe) = &old.skeleton {
        let next = to.operand().filter(|next| next != recipe)?;
        return shaped(old, &to.name, next);
    }
    let was = own_way(from, stood)?;
    let is = own_way(to, stands)?;
    let far = was.points().iter().zip(is.points());
    // As exact as single precision is where the painting stands.
    let size = stands.translation.abs().max_element().max(1.0);
    let close = f64::from(4.0 * f32::EPSILON * size / stands.scale.abs().min_element());
    let still = was.points().len() == is.points().len()
        && far.fold(0.0f64, |m, (a, b)| m.max(a.distance(*b))) < close;
    // What is moved together with its source stands to it as before.
    if still {
        return None;
    }
    let radii = match &old.skeleton {
        Skeleton::Points(points) => points.first().map_or(1.0, |p| p.w),
        _ => 1.0,
    };
    let own = Polyline::new(old_way(&old.skeleton)?);
    let share = |p: DVec3| is.nearest(p) / is.length().max(1e-12);
    // Where the painting was moved since, the stroke keeps its distance from its source.
    let points = is.points().iter().map(|&p| {
        let t = share(p);
        let away = own.at(t * own.length())? - was.at(t * was.length())?;
        Some((p + away).as_vec3())
    });
    let points: Vec<Vec3> = points.collect::<Option<_>>()?;
    let skeleton = match points.as_slice() {
        [a, b] if a.distance(*b) > 1e-3 * old.radius => Skeleton::Line(*a, *b),
        [_, _] | [] => return None,
        many => {
            let way: Vec<Vec4> = many.iter().map(|p| p.extend(radii)).collect();
            Skeleton::Points(way.into())
        }
    };
    let next = Stroke {
        skeleton,
        ..old.clone()
    };
    // A line that is short still has its surface at its radius.
    let fit = |s: &Stroke| match s.skeleton {
        Skeleton::Line(..) => s.fitted_weight(reach),
        _ => 1.0,
    };
    Some(Stroke {
        weight: old.weight * fit(&next) / fit(old),
        ..next
    })
}

/// Painted with another solid in its place, as large against itself as before.
fn shaped(old: &Stroke, name: &str, recipe: Recipe) -> Option<Stroke> {
    let frame = stroke::Frame::of(&Placement::IDENTITY);
    let made = stroke::volume((name, &recipe), &Placement::IDENTITY, &frame).ok()?;
    Some(Stroke {
        skeleton: made.skeleton,
        radius: made.radius,
        ..old.clone()
    })
}

/// The way of a drawn line or stroke in the frame of a painting that stands there.
fn own_way(source: &Object, painting: &Placement) -> Option<Polyline> {
    let frame = stroke::Frame::of(painting);
    let points = way(source)?;
    Some(Polyline::new(
        points.into_iter().map(|p| frame.point(p).as_dvec3()),
    ))
}

fn old_way(skeleton: &Skeleton) -> Option<Vec<DVec3>> {
    match skeleton {
        Skeleton::Points(points) => Some(points.iter().map(|p| p.truncate().as_dvec3()).collect()),
        Skeleton::Line(a, b) => Some(vec![a.as_dvec3(), b.as_dvec3()]),
        Skeleton::Polygon(_) | Skeleton::Volume(_) => None,
    }
}

/// The sources that strokes of a painting follow, as links: `first` is the place of the first of them.
pub(crate) fn links(first: usize, sources: &[Option<ObjectId>]) -> Vec<Link> {
    let each = sources.iter().enumerate();
    each.filter_map(|(k, source)| {
        Some(Link {
            source: (*source)?,
            part: (first + k) as u32,
        })
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(x: f32) -> Stroke {
        Stroke::new(Skeleton::Points([Vec4::new(x, 0.0, 0.0, 1.0)].into()), 0.1)
    }

    fn link(part: u32) -> Link {
        Link {
            source: ObjectId(1),
            part,
        }
    }

    #[test]
    fn a_link_goes_with_its_stroke() {
        let old: Vec<Stroke> = (0..5).map(|i| dot(i as f32)).collect();
        let all: Vec<Link> = (0..5).map(link).collect();
        let parts = |new: &[Stroke]| -> Vec<u32> {
            let kept = kept(&all, &all, &old, new);
            kept.iter().map(|l| l.part).collect()
        };
        let mut gone = old.clone();
        gone.remove(1);
        assert_eq!(
            parts(&gone),
            [0, 1, 2, 3],
            "the second is gone, the others are one earlier"
        );
        let mut changed = old.clone();
        changed[2].weight = 2.0;
        assert_eq!(parts(&changed), [0, 1, 2, 3, 4]);
        let mut more = old.clone();
        more.insert(2, dot(9.0));
        assert_eq!(parts(&more), [0, 1, 3, 4, 5]);
        assert_eq!(parts(&[]), [] as [u32; 0]);
        // One that came in the same change is right as it is.
        let mut grown = old.clone();
        grown.push(dot(7.0));
        let now: Vec<Link> = all.iter().copied().chain([link(5)]).collect();
        assert_eq!(kept(&all, &now, &old, &grown), now);
    }
}
