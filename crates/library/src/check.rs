use midair_field::{CompileError, Placement, Program, Recipe};

/// The largest extent a component may have, in metres: beyond it nothing fits a working scene.
const LARGEST: f32 = 100.0;
/// The smallest, in metres: a tenth of the finest step that can be set.
const SMALLEST: f32 = 1e-4;

/// Whether a recipe describes a solid of a size that can be placed; if not, what is wrong with it.
pub(crate) fn check(recipe: &Recipe) -> Result<(), String> {
    recipe.validate().map_err(|e| e.to_string())?;
    let size = recipe.bounds().size();
    if recipe.bounds().is_empty() {
        return Err("the solid is empty".to_owned());
    }
    let longest = size.max_element();
    if !(SMALLEST..=LARGEST).contains(&longest) {
        return Err(format!(
            "its longest side is {longest} m; it must lie between {SMALLEST} and {LARGEST} metres"
        ));
    }
    match Program::compile(recipe, &Placement::IDENTITY, midair_field::bake::STEP, &()) {
        // Whether its meshes are there is asked elsewhere.
        Ok(_) | Err(CompileError::MissingMesh(_)) => Ok(()),
        Err(e) => Err(e.to_string()),
    }
}
