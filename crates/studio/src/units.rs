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
}
