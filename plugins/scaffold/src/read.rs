//! From what a hand drew to what the document holds: the readings of lines and strokes.

use bevy::math::{DAffine3, DVec3};
use midair_beautify::stroke::Fair;
use midair_beautify::{
    Constraint, Corrected, End, Line, LineOptions, Scaffold, StrokeOptions, correct_line,
    fair_stroke, readings,
};
use midair_curve::{Polyline, Spline};
use midair_document::{
    ConstructionLine, DrawnStroke, Kept, Kind, LineReading, ObjectId, Relation, StrokeReading,
    Through,
};
use midair_studio::drawing::{Drawing, on_piece};

/// How many readings are offered.
const MOST: usize = 5;
/// A stroke may leave what was drawn by so many times its threshold and by this share of its length; beyond
/// that it stays as it was drawn.
const FAR: (f64, f64) = (3.0, 0.12);

/// One way to read what was drawn, in world metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// What it becomes.
    pub kind: Kind,
    /// A few words: "parallel, equal", "as drawn".
    pub words: String,
}

/// The construction lines that can be seen, and which objects they are.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// As the kernel takes them.
    pub scaffold: Scaffold,
    /// The object of each line.
    pub ids: Vec<ObjectId>,
    /// The lines of the tick marks.
    tick_ids: Vec<ObjectId>,
}

impl Scene {
    /// All but `without`.
    pub fn of(drawing: &Drawing, without: &[ObjectId]) -> Self {
        let mut scene = Self::default();
        for line in drawing.lines().iter().filter(|l| !without.contains(&l.id)) {
            scene.scaffold.lines.push(Line::new(line.a, line.b));
            scene.ids.push(line.id);
            scene.scaffold.ticks.extend(&line.ticks);
            let ticks = line.ticks.iter().map(|_| line.id);
            scene.tick_ids.extend(ticks);
        }
        scene
    }

    /// The line that has a keypoint there.
    fn at(&self, point: DVec3) -> Option<ObjectId> {
        let near = |p: &DVec3| p.distance_squared(point) < 1e-14;
        let of_line = |l: &Line| [l.a, l.b, l.a.midpoint(l.b)].iter().any(near);
        let ticks = &self.scaffold.ticks;
        (self.scaffold.lines.iter().position(of_line))
            .map(|i| self.ids[i])
            .or_else(|| ticks.iter().position(near).map(|i| self.tick_ids[i]))
    }

    fn kept(&self, constraint: &Constraint) -> Kept {
        let of = |line: Option<usize>| line.and_then(|i| self.ids.get(i)).copied();
        let second = |end: End| Some(end == End::B);
        let (relation, end, with) = match *constraint {
            Constraint::PointPoint { end, point } => (Relation::Meets, second(end), self.at(point)),
            Constraint::PointLine { end, line, .. } => {
                (Relation::Touches, second(end), of(Some(line)))
            }
            Constraint::Perpendicular { line, .. } => (Relation::Square, None, of(line)),
            Constraint::Parallel { line, .. } => (Relation::Parallel, None, of(line)),
            Constraint::EqualLength { line, .. } => (Relation::Equal, None, of(Some(line))),
            Constraint::Angle { line, .. } => (Relation::Angle, None, of(Some(line))),
        };
        Kept {
            relation,
            end,
            with,
        }
    }
}

/// The readings of a line, the best first and what was drawn last. Says as well whether correction was refused,
/// since it would have moved the line too far.
pub fn line(drawn: &Line, scene: &Scene, options: &LineOptions) -> (Vec<Reading>, bool) {
    let found = readings(drawn, &scene.scaffold, options, MOST);
    let refused = found.first().is_some_and(|r| r.refused);
    let mut all: Vec<Reading> = found
        .iter()
        .map(|one| line_reading(drawn, one, scene, options))
        .collect();
    // The plain line is always among them, last.
    let plain = line_as_drawn(drawn, options);
    let is_plain = |r: &Reading| matches!((&r.kind, &plain.kind), (Kind::Line(a), Kind::Line(b)) if a.a == b.a && a.b == b.b && a.kept.is_empty());
    all.retain(|r| !is_plain(r));
    all.push(plain);
    (all, refused)
}

/// The best reading of a line alone: what is shown while it is pulled.
pub fn best_line(drawn: &Line, scene: &Scene, options: &LineOptions) -> Option<Reading> {
    let best = correct_line(drawn, &scene.scaffold, options);
    (!best.refused).then(|| line_reading(drawn, &best, scene, options))
}

fn line_as_drawn(drawn: &Line, options: &LineOptions) -> Reading {
    Reading {
        kind: Kind::Line(ConstructionLine {
            reading: LineReading {
                auto: false,
                ..told(options)
            },
            ..ConstructionLine::raw(drawn.a, drawn.b)
        }),
        words: "as drawn".to_owned(),
    }
}

fn line_reading(drawn: &Line, one: &Corrected, scene: &Scene, options: &LineOptions) -> Reading {
    let kept: Vec<Kept> = one.kept.iter().map(|c| scene.kept(c)).collect();
    Reading {
        words: words(&kept),
        kind: Kind::Line(ConstructionLine {
            a: one.line.a,
            b: one.line.b,
            raw: [drawn.a, drawn.b],
            ticks: Vec::new(),
            kept,
            reading: told(options),
        }),
    }
}

fn told(options: &LineOptions) -> LineReading {
    LineReading {
        auto: true,
        distance: options.distance / options.metres_per_world,
        angle: options.angle,
        length: options.length,
    }
}

/// The relations of a line, each once.
pub fn words(kept: &[Kept]) -> String {
    let mut named: Vec<&str> = Vec::new();
    for k in kept {
        let name = match k.relation {
            Relation::Meets => "on a point",
            Relation::Touches => "on a line",
            Relation::Square if k.with.is_none() => "level",
            Relation::Parallel if k.with.is_none() => "upright",
            Relation::Square => "square",
            Relation::Parallel => "parallel",
            Relation::Equal => "equal",
            Relation::Angle => "at an even angle",
        };
        if !named.contains(&name) {
            named.push(name);
        }
    }
    if named.is_empty() {
        "near nothing".to_owned()
    } else {
        named.join(", ")
    }
}

/// The readings of a stroke, the best first and what was drawn last.
pub fn stroke(
    drawn: &[DVec3],
    width: f64,
    scene: &Scene,
    options: &StrokeOptions,
) -> (Vec<Reading>, bool) {
    let plain = DrawnStroke {
        reading: StrokeReading {
            auto: false,
            ..told_stroke(options)
        },
        ..DrawnStroke::raw(drawn.to_vec(), width)
    };
    let plain = Reading {
        kind: Kind::Stroke(plain.into()),
        words: "as drawn".to_owned(),
    };
    let mut refused = false;
    let mut all: Vec<Reading> = Vec::new();
    let free = Scaffold::default();
    let loose = StrokeOptions {
        angle: 0.0,
        ..*options
    };
    let straight = StrokeOptions {
        straight_distance: f64::INFINITY,
        straight_length: f64::INFINITY,
        ..*options
    };
    let ways: [(&str, &Scaffold, &StrokeOptions); 4] = [
        ("", &scene.scaffold, options),
        ("without following lines", &scene.scaffold, &loose),
        ("away from the scaffold", &free, options),
        ("straight", &scene.scaffold, &straight),
    ];
    // A way that could not differ from the first costs a fit and gives nothing.
    let mut sense = [true; 4];
    for (i, (name, scaffold, options)) in ways.into_iter().enumerate() {
        if !sense[i] {
            continue;
        }
        let Some((kind, say)) = stroke_reading(drawn, width, scaffold, options) else {
            continue;
        };
        if i == 0 {
            let inner = kind.through.len().saturating_sub(1);
            sense = [
                true,
                kind.through.iter().any(|k| k.along_line),
                kind.through.iter().any(|k| k.of_scaffold),
                !kind.closed
                    && !(1..inner).any(|k| kind.through[k].of_scaffold)
                    && say != "straight",
            ];
        }
        // What is straightened on purpose may leave what was drawn.
        if i < 3 && far(drawn, &kind, options) {
            refused |= i == 0;
            continue;
        }
        if i == 3 && say != "straight" || all.iter().any(|r| alike(&r.kind, &kind, options)) {
            continue;
        }
        all.push(Reading {
            kind: Kind::Stroke(kind.into()),
            words: if name.is_empty() {
                say
            } else {
                name.to_owned()
            },
        });
    }
    if refused {
        all.clear();
    }
    all.push(plain);
    (all, refused)
}

fn stroke_reading(
    drawn: &[DVec3],
    width: f64,
    scaffold: &Scaffold,
    options: &StrokeOptions,
) -> Option<(DrawnStroke, String)> {
    let (spline, through, closed, words) = match fair_stroke(drawn, scaffold, options) {
        Fair::Nothing => return None,
        Fair::Straight(line) => {
            let ends = [line.a, line.b].map(|point| Through {
                point,
                of_scaffold: scaffold.keypoints().any(|k| k == point),
                along_line: false,
            });
            let spline = Spline::straight(line.a, line.b);
            (spline, ends.to_vec(), false, "straight".to_owned())
        }
        Fair::Curve {
            spline,
            keypoints,
            closed,
        } => {
            let through: Vec<Through> = keypoints
                .iter()
                .map(|k| Through {
                    point: k.point,
                    of_scaffold: k.of_scaffold,
                    along_line: k.along_line,
                })
                .collect();
            let count = through.iter().filter(|k| k.of_scaffold).count();
            let count = count - usize::from(closed && count > 1);
            let s = if count == 1 { "" } else { "s" };
            let words = match count {
                0 => "fair".to_owned(),
                _ => format!("fair, through {count} point{s}"),
            };
            (spline, through, closed, words)
        }
    };
    let stroke = DrawnStroke {
        raw: drawn.to_vec(),
        segments: spline.segments.iter().map(|s| s.0).collect(),
        closed,
        width,
        through,
        reading: told_stroke(options),
    };
    Some((stroke, words))
}

fn told_stroke(options: &StrokeOptions) -> StrokeReading {
    StrokeReading {
        auto: true,
        distance: options.distance / options.metres_per_world,
        angle: options.angle,
        spacing: options.spacing / options.metres_per_world,
    }
}

/// Whether a curve leaves what was drawn by more than its thresholds allow.
fn far(drawn: &[DVec3], stroke: &DrawnStroke, options: &StrokeOptions) -> bool {
    let line = Polyline::new(drawn.iter().copied());
    let reach = options.distance / options.metres_per_world;
    let most = FAR.0 * reach + FAR.1 * line.length();
    let samples = line.resampled(160);
    Polyline::new(stroke.points())
        .resampled(80)
        .iter()
        .any(|&p| to_polyline(p, &samples) > most)
}

fn to_polyline(p: DVec3, points: &[DVec3]) -> f64 {
    points
        .windows(2)
        .map(|w| on_piece(p, w[0], w[1]).distance_squared(p))
        .fold(f64::INFINITY, f64::min)
        .sqrt()
}

/// Whether two strokes look the same.
fn alike(a: &Kind, b: &DrawnStroke, options: &StrokeOptions) -> bool {
    let Kind::Stroke(a) = a else { return false };
    let resampled = |s: &DrawnStroke| Polyline::new(s.points()).resampled(24);
    resampled(a)
        .iter()
        .zip(resampled(b))
        .all(|(p, q)| p.distance(q) * options.metres_per_world < 1.5e-3)
}

/// What was drawn with the lines and strokes of the world, in the frame of an object that stands elsewhere.
pub fn carried(kind: &Kind, by: &DAffine3) -> Kind {
    let at = |p: DVec3| by.transform_point3(p);
    match kind {
        Kind::Line(line) => Kind::Line(ConstructionLine {
            a: at(line.a),
            b: at(line.b),
            raw: line.raw.map(at),
            ..line.clone()
        }),
        Kind::Stroke(stroke) => Kind::Stroke(
            DrawnStroke {
                raw: stroke.raw.iter().copied().map(at).collect(),
                segments: stroke.segments.iter().map(|s| s.map(at)).collect(),
                through: stroke
                    .through
                    .iter()
                    .map(|k| Through {
                        point: at(k.point),
                        ..*k
                    })
                    .collect(),
                ..(**stroke).clone()
            }
            .into(),
        ),
        other => other.clone(),
    }
}
