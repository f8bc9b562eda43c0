use glam::{Quat, Vec3};
use midair_field::{Node, Op, Operand, Placement, Program, Recipe};
use midair_gpu::measure::Work;

use crate::catalogue::BenchError;

/// `count` components in a heap, every third taken away: more operands than the six that
/// EasyVRModeling §6 found to be too many for its lazy update.
pub(crate) fn recipe(count: usize) -> Result<Recipe, BenchError> {
    let text = include_str!("../../../benches/parts.ron");
    let parts: Vec<Recipe> = ron::from_str(text).map_err(|e| BenchError::Recipe("parts", e))?;
    let operands = parts.iter().cycle().take(count).enumerate();
    let operands = operands.map(|(i, part)| {
        // The golden angle spreads them evenly, whatever their number.
        let (turn, height) = (2.399_963_2 * i as f32, i as f32 / count as f32 - 0.5);
        let radius = 0.25 * (1.0 - 2.0 * height.abs()) + 0.05;
        Operand {
            op: if i % 3 == 2 { Op::Subtract } else { Op::Union },
            placement: Placement {
                translation: Vec3::new(radius * turn.cos(), 0.6 * height, radius * turn.sin()),
                rotation: Quat::from_rotation_y(turn) * Quat::from_rotation_x(0.7 * turn),
                scale: Vec3::splat(0.5),
            },
            recipe: part.clone(),
            muted: false,
        }
    });
    Ok(Recipe::new(Node::Solid(operands.collect())))
}

/// The same by the card, at a step.
pub(crate) fn on_card(count: usize, step: f32, name: String) -> Work {
    Work::new(name, move || {
        let recipe = recipe(count).map_err(|e| e.to_string())?;
        let made = Program::compile(&recipe, &Placement::IDENTITY, step, &());
        Ok((None, made.map_err(|e| e.to_string())?))
    })
}
