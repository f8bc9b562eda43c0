//! What mouse, keyboard and gamepad ask for: controls, what they are bound to, what is pressed.

mod binding;
mod control;
mod file;
mod keep;
mod listen;
mod moments;
mod part;
mod rebind;
mod table;

use bevy::prelude::*;
use leafwing_input_manager::plugin::{CentralInputStorePlugin, InputManagerSystem};

pub use binding::{Binding, BindingFault, Stick};
pub use control::{Context, Control, Group};
pub use listen::{Attention, Controls};
pub(crate) use moments::Cursor;
pub use part::{Device, Part};
pub(crate) use rebind::{Asked, Rebind, Rebinding};
pub use table::Bindings;

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins((CentralInputStorePlugin, keep::plugin))
        .init_resource::<Bindings>()
        .init_resource::<Attention>()
        .init_resource::<Controls>()
        .init_resource::<Cursor>()
        .init_resource::<Asked>()
        .init_resource::<Rebinding>()
        .add_systems(
            PreUpdate,
            leafwing_input_manager::systems::clear_central_input_store
                .in_set(InputManagerSystem::Tick)
                .before(InputManagerSystem::Unify),
        )
        .add_systems(
            PreUpdate,
            // What is bound anew is not heard before its key is up.
            (rebind::rebind, listen::listen)
                .chain()
                .in_set(InputManagerSystem::Update)
                .after(InputManagerSystem::Unify),
        );
}
