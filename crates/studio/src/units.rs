//! Lengths as people read them. Inside, everything is metres.

use midair_mesh::Unit;

/// A length as people read it: as many digits as say something in that unit.
pub fn length(metres: f32, unit: Unit) -> String {
    let value = f64::from(metres) * unit.per_metre();
    let digits = match unit {
        Unit::Mm => 1,
        Unit::Cm | Unit::Inch => 2,
        Unit::M => 3,
    };
    format!("{value:.digits$} {}", symbol(unit))
}

/// What was typed, in metres: a number in `unit`, or in the unit that stands behind it. None where it is no length.
pub fn metres(text: &str, unit: Unit) -> Option<f32> {
    let text = text.trim();
    let (number, unit) = [Unit::Mm, Unit::Cm, Unit::Inch, Unit::M]
        .into_iter()
        .find_map(|unit| Some((text.strip_suffix(symbol(unit))?, unit)))
        .unwrap_or((text, unit));
    let value: f64 = number.trim_end().replace(',', ".").parse().ok()?;
    value.is_finite().then(|| (value / unit.per_metre()) as f32)
}

/// Width, height and depth in one line.
pub fn size(metres: bevy::math::Vec3, unit: Unit) -> String {
    let bare = |m: f32| {
        let text = length(m, unit);
        text.split(' ').next().unwrap_or_default().to_owned()
    };
    format!(
        "{} × {} × {}",
        bare(metres.x),
        bare(metres.y),
        length(metres.z, unit)
    )
}

fn symbol(unit: Unit) -> &'static str {
    match unit {
        Unit::Mm => "mm",
        Unit::Cm => "cm",
        Unit::M => "m",
        Unit::Inch => "in",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Vec3;

    #[test]
    fn lengths_are_said_in_the_unit_asked_for() {
        assert_eq!(length(0.0254, Unit::Inch), "1.00 in");
        assert_eq!(length(0.1234, Unit::Mm), "123.4 mm");
        assert_eq!(length(1.5, Unit::M), "1.500 m");
        assert_eq!(
            size(Vec3::new(0.1, 0.2, 0.3), Unit::Cm),
            "10.00 × 20.00 × 30.00 cm"
        );
    }

    #[test]
    fn a_typed_length_is_in_the_unit_on_screen_or_in_its_own() {
        let is = |text: &str, to: f32| (metres(text, Unit::Mm).unwrap() - to).abs() < 1e-6;
        assert!(is("30", 0.03) && is(" 30,5 mm", 0.0305) && is("3cm", 0.03));
        assert!(is("0.1 m", 0.1) && is("1in", 0.0254));
        for none in ["", "mm", "ten", "inf", "NaN m"] {
            assert_eq!(metres(none, Unit::Mm), None, "{none}");
        }
    }
}
