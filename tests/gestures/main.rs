//! Whole gestures through the hands, in the whole studio; and the training sessions, measured
//! against an exact boolean.

mod brush;
mod brush_session;
mod carry;
mod desk;
mod dropping;
mod fuzz;
mod gamepad;
mod holding;
mod keyboard;
mod leaving;
mod looks;
mod materials;
mod mouse;
mod mouse_session;
mod newcomer;
mod objects;
mod operands;
mod oracle;
mod pad_session;
mod preview;
mod references;
mod room;
mod scaffold;
mod scaffold_flat;
mod sequence;
mod shapes;
mod small;
mod studio;
mod surfaces;
mod sweep;
mod symmetry;
mod training;
mod trouble;
mod tutorial;
mod undoing;
