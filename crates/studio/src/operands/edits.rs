//! From what was asked to the edits that do it.

use std::sync::Arc;

use midair_document::{Document, Edit, Object, ObjectId};
use midair_field::{Node, Op, Operand, Recipe};

use super::place::outside;
use super::{Of, OperandAsk};

/// Why nothing was done.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Refused {
    #[error("There is no such operand any more. Select the solid again.")]
    Nowhere,
    #[error("The last operand that takes part stays: muted or removed, nothing would be left.")]
    Last,
    #[error("A marked operand is left out by unmarking it.")]
    Marked,
    #[error("A marked operand is an object already: move it where it stands.")]
    Outside,
    #[error("This solid was not made from operands, so there is nothing to take apart.")]
    Whole,
    #[error("That part is locked. Unlock it in the outline first.")]
    Locked,
}

type Step = (String, Vec<Edit>);

/// The operands at a path into a solid; `None` where there are none.
pub fn listed<'a>(recipe: &'a Recipe, path: &[usize]) -> Option<&'a [Operand]> {
    let Node::Solid(operands) = recipe.node() else {
        return None;
    };
    match path {
        [] => Some(operands),
        [first, rest @ ..] => listed(&operands.get(*first)?.recipe, rest),
    }
}

/// What people call an operand.
pub fn name(recipe: &Recipe, at: usize) -> String {
    match recipe.node() {
        Node::Component { id, .. } => {
            let last = id.rsplit('/').next().unwrap_or(id).replace(['-', '_'], " ");
            let mut letters = last.chars();
            let first = letters.next().map(|c| c.to_uppercase().to_string());
            first.map_or_else(|| format!("Part {}", at + 1), |f| f + letters.as_str())
        }
        Node::Solid(_) => format!("Solid, part {}", at + 1),
        _ => format!("Part {}", at + 1),
    }
}

pub(super) fn edits(ask: &OperandAsk, document: &Document) -> Result<Step, Refused> {
    match ask {
        OperandAsk::Unfuse { object } => unfuse(document, *object),
        OperandAsk::TakeOut { of } => take_out(document, of),
        OperandAsk::Join { of, op } => change(document, of, "Join otherwise", |list, at| {
            list[at].op = *op;
        }),
        OperandAsk::Mute { of, muted } => {
            let verb = if *muted {
                "Mute operand"
            } else {
                "Unmute operand"
            };
            match of.object {
                None => Err(Refused::Marked),
                Some(_) => change(document, of, verb, |list, at| list[at].muted = *muted),
            }
        }
        OperandAsk::Move { of, to } => change(document, of, "Reorder operands", |list, at| {
            let one = list.remove(at);
            list.insert((*to).min(list.len()), one);
        }),
        OperandAsk::Remove { of } => change(document, of, "Remove operand", |list, at| {
            list.remove(at);
        }),
    }
}

/// One change of one list of operands, of the marked sequence too.
fn change(
    document: &Document,
    of: &Of,
    verb: &str,
    with: impl FnOnce(&mut Vec<Operand>, usize),
) -> Result<Step, Refused> {
    let edit = match of.object {
        Some(id) => {
            let recipe = recipe_of(document, id)?;
            Edit::set_recipe(id, changed(recipe, &of.path, with)?)
        }
        None => {
            // The same change, on a list of the same shape.
            let &[at] = of.path.as_slice() else {
                return Err(Refused::Nowhere);
            };
            let marks = document.pending();
            let stand_in = |i: usize, op| Operand {
                op,
                placement: midair_field::Placement::at(bevy::math::Vec3::splat(i as f32)),
                recipe: Recipe::new(Node::Solid(Vec::new())),
                muted: false,
            };
            let each = marks.iter().enumerate();
            let mut list: Vec<_> = each.map(|(i, &(_, op))| stand_in(i, op)).collect();
            if at >= list.len() {
                return Err(Refused::Nowhere);
            }
            with(&mut list, at);
            let pending = list
                .iter()
                .map(|o| (marks[o.placement.translation.x as usize].0, o.op))
                .collect();
            Edit::SetPending { pending }
        }
    };
    Ok((verb.to_owned(), vec![edit]))
}

fn recipe_of(document: &Document, id: ObjectId) -> Result<&Recipe, Refused> {
    let object = document.object(id).ok_or(Refused::Nowhere)?;
    if document.is_locked(id) {
        return Err(Refused::Locked);
    }
    object.recipe().ok_or(Refused::Whole)
}

fn changed(
    recipe: &Recipe,
    path: &[usize],
    with: impl FnOnce(&mut Vec<Operand>, usize),
) -> Result<Recipe, Refused> {
    let Node::Solid(operands) = recipe.node() else {
        return Err(Refused::Whole);
    };
    let mut operands = operands.clone();
    match path {
        [] => return Err(Refused::Nowhere),
        &[at] if at < operands.len() => {
            with(&mut operands, at);
            if operands.iter().all(|o| o.muted) {
                return Err(Refused::Last);
            }
        }
        [at, rest @ ..] => {
            let inner = operands.get_mut(*at).ok_or(Refused::Nowhere)?;
            inner.recipe = changed(&inner.recipe, rest, with)?;
        }
    }
    Ok(Recipe::new(Node::Solid(operands)))
}

fn take_out(document: &Document, of: &Of) -> Result<Step, Refused> {
    let id = of.object.ok_or(Refused::Outside)?;
    let recipe = recipe_of(document, id)?;
    let whole = document.object(id).ok_or(Refused::Nowhere)?;
    let rest = changed(recipe, &of.path, |list, at| {
        list.remove(at);
    })?;
    // From the inside out: each solid on the way places what lies in it.
    let (&at, above) = of.path.split_last().ok_or(Refused::Nowhere)?;
    let mut one = listed(recipe, above)
        .and_then(|list| list.get(at))
        .ok_or(Refused::Nowhere)?
        .clone();
    let label = name(&one.recipe, at);
    for depth in (0..above.len()).rev() {
        let around = listed(recipe, &above[..depth])
            .and_then(|list| list.get(above[depth]))
            .ok_or(Refused::Nowhere)?;
        let (recipe, placement) = outside(&around.placement, &one);
        one = Operand {
            op: Op::Union,
            placement,
            recipe,
            muted: false,
        };
    }
    let (alone, placement) = outside(&whole.placement, &one);
    let mut object = Object::solid(label.clone(), alone).placed(placement);
    object.layer = whole.layer;
    object.group = whole.group;
    let new = ObjectId(document.next_id());
    Ok((
        format!("Take out {label}"),
        vec![
            Edit::set_recipe(id, rest),
            Edit::Add {
                id: new,
                object: Arc::new(object),
            },
        ],
    ))
}

fn unfuse(document: &Document, id: ObjectId) -> Result<Step, Refused> {
    let whole = document.object(id).ok_or(Refused::Nowhere)?;
    let operands = listed(recipe_of(document, id)?, &[]).ok_or(Refused::Whole)?;
    let mut edits = vec![Edit::Remove { id }];
    let mut pending: Vec<_> = document.pending().to_vec();
    pending.retain(|(o, _)| *o != id);
    for (i, operand) in operands.iter().enumerate() {
        let (recipe, placement) = outside(&whole.placement, operand);
        let mut object = Object::solid(name(&operand.recipe, i), recipe).placed(placement);
        object.layer = whole.layer;
        object.group = whole.group;
        let new = ObjectId(document.next_id() + i as u64);
        edits.push(Edit::Add {
            id: new,
            object: Arc::new(object),
        });
        if !operand.muted {
            pending.push((new, operand.op));
        }
    }
    edits.push(Edit::SetPending { pending });
    Ok((format!("Unfuse {}", whole.name), edits))
}
