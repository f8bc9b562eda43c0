//! The drawing on one sheet: front, side, top and an isometric view as an SVG, in millimetres and to scale.

use std::fmt::Write;

use bevy::math::{DVec2, DVec3};
use midair_document::{Document, Kind, affine};

/// Millimetres between the views and around them.
const MARGIN: f64 = 15.0;
/// Construction lines are drawn so wide, and strokes at least so, in millimetres.
const THIN: (f64, f64) = (0.25, 0.5);

/// One path in the world, in metres: Bézier segments, or points joined by straight lines.
enum Path {
    Straight(Vec<DVec3>),
    Curved(Vec<[DVec3; 4]>),
}

struct Drawn {
    path: Path,
    /// Millimetres; none for a construction line.
    width: Option<f64>,
}

/// A view: what of the world is to the right on paper, and what is up.
struct View {
    name: &'static str,
    right: DVec3,
    up: DVec3,
}

impl View {
    fn at(&self, p: DVec3) -> DVec2 {
        // Paper counts downwards.
        DVec2::new(p.dot(self.right), -p.dot(self.up)) * 1e3
    }
}

fn views() -> [View; 4] {
    let (c, s) = (std::f64::consts::FRAC_1_SQRT_2, 1.0 / 6.0_f64.sqrt());
    let view = |name, right, up| View { name, right, up };
    [
        view("front", DVec3::X, DVec3::Y),
        view("right side", DVec3::NEG_Z, DVec3::Y),
        view("top", DVec3::X, DVec3::NEG_Z),
        view(
            "isometric",
            DVec3::new(c, 0.0, -c),
            DVec3::new(-s, 2.0 * s, -s),
        ),
    ]
}

/// The sheet; `None` where no line or stroke can be seen.
pub fn sheet(document: &Document) -> Option<String> {
    let drawn: Vec<Drawn> = document
        .objects()
        .filter(|(id, _)| document.is_visible(*id))
        .filter_map(|(_, object)| {
            let there = affine(&object.placement);
            let at = |p: &DVec3| there.transform_point3(*p);
            Some(match &object.kind {
                Kind::Line(line) => Drawn {
                    path: Path::Straight(line.ends().iter().map(at).collect()),
                    width: None,
                },
                Kind::Stroke(stroke) => Drawn {
                    path: if stroke.segments.is_empty() {
                        Path::Straight(stroke.points().iter().map(at).collect())
                    } else {
                        let segments = stroke.segments.iter();
                        Path::Curved(segments.map(|s| s.map(|p| at(&p))).collect())
                    },
                    width: Some(stroke.width * 1e3),
                },
                _ => return None,
            })
        })
        .collect();
    if drawn.is_empty() {
        return None;
    }
    let views = views();
    let boxes = views.each_ref().map(|view| extent(view, &drawn));
    let size = boxes.map(|(low, high)| high - low);
    // The side view stands beside the front, the top view below it.
    let (left, upper) = (size[0].x.max(size[2].x), size[0].y.max(size[1].y));
    let (right, lower) = (size[1].x.max(size[3].x), size[2].y.max(size[3].y));
    let (x, y) = (2.0 * MARGIN + left, 2.0 * MARGIN + upper);
    let (wide, high) = (x + right + MARGIN, y + lower + MARGIN);
    let corners = [
        DVec2::new(MARGIN, MARGIN + upper - size[0].y),
        DVec2::new(x, MARGIN + upper - size[1].y),
        DVec2::new(MARGIN, y),
        DVec2::new(x, y),
    ];
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide:.2}mm\" height=\"{high:.2}mm\" \
         viewBox=\"0 0 {wide:.2} {high:.2}\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for ((view, (low, _)), corner) in views.iter().zip(boxes).zip(corners) {
        let by = corner - low;
        // Writing to a string does not fail.
        let _ = writeln!(out, "<g id=\"{}\">", view.name.replace(' ', "-"));
        let _ = writeln!(
            out,
            "<text x=\"{:.2}\" y=\"{:.2}\" font-family=\"sans-serif\" font-size=\"4\" fill=\"#555\">{}</text>",
            corner.x,
            corner.y - 4.0,
            view.name
        );
        // Strokes over lines.
        for strokes in [false, true] {
            for one in drawn.iter().filter(|d| d.width.is_some() == strokes) {
                let (colour, width) = match one.width {
                    None => ("#999", THIN.0),
                    Some(width) => ("black", width.max(THIN.1)),
                };
                let _ = writeln!(
                    out,
                    "<path d=\"{}\" stroke=\"{colour}\" stroke-width=\"{width:.2}\"/>",
                    path(&one.path, |p| view.at(p) + by)
                );
            }
        }
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    Some(out)
}

/// The box around what is drawn; a curve lies within that of its control points.
fn extent(view: &View, drawn: &[Drawn]) -> (DVec2, DVec2) {
    let mut whole = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for one in drawn {
        let side = 0.5 * one.width.unwrap_or(THIN.0);
        let mut take = |p: DVec3| {
            let p = view.at(p);
            whole = (whole.0.min(p - side), whole.1.max(p + side));
        };
        match &one.path {
            Path::Straight(points) => points.iter().copied().for_each(&mut take),
            Path::Curved(segments) => segments.iter().flatten().copied().for_each(&mut take),
        }
    }
    whole
}

fn path(path: &Path, at: impl Fn(DVec3) -> DVec2) -> String {
    let mut out = String::new();
    let mut say = |command: &str, points: &[DVec3]| {
        out.push_str(command);
        for p in points {
            let p = at(*p);
            let _ = write!(out, "{:.3} {:.3} ", p.x, p.y);
        }
    };
    match path {
        Path::Straight(points) => {
            for (i, p) in points.iter().enumerate() {
                say(if i == 0 { "M" } else { "L" }, &[*p]);
            }
        }
        Path::Curved(segments) => {
            for (i, s) in segments.iter().enumerate() {
                if i == 0 {
                    say("M", &s[..1]);
                }
                say("C", &s[1..]);
            }
        }
    }
    out.truncate(out.trim_end().len());
    out
}

#[cfg(test)]
mod tests {
    use midair_document::{ConstructionLine, DrawnStroke, Edit, Object, ObjectId};

    use super::*;

    #[test]
    fn a_line_has_its_length_on_paper_and_nothing_gives_no_sheet() {
        let mut document = Document::new();
        assert_eq!(sheet(&document), None);
        let a = DVec3::new(0.1, 0.2, 0.3);
        let line = ConstructionLine::raw(a, a + DVec3::X * 0.25);
        let stroke = DrawnStroke::raw(vec![a, a + DVec3::Y * 0.1], 0.008);
        for kind in [Kind::Line(line), Kind::Stroke(stroke.into())] {
            let id = ObjectId(document.next_id());
            let object = Object::new("", kind).into();
            document.apply(&Edit::Add { id, object }).unwrap();
        }
        let sheet = sheet(&document).unwrap();
        let front = sheet.split("<g id=").nth(1).unwrap();
        let d = front.split("d=\"M").nth(1).unwrap().split('"').next();
        let numbers: Vec<f64> = d
            .unwrap()
            .split(['L', ' '])
            .filter_map(|n| n.parse().ok())
            .collect();
        assert_eq!(numbers.len(), 4, "{front}");
        assert!((numbers[2] - numbers[0] - 250.0).abs() < 1e-6 && numbers[1] == numbers[3]);
        assert_eq!(
            sheet
                .matches("stroke=\"black\" stroke-width=\"8.00\"")
                .count(),
            4
        );
        assert_eq!(sheet.matches("<g ").count(), sheet.matches("</g>").count());
    }
}
