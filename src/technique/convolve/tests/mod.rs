//! Convolution shadows against what is known of them: to the last bit, in closed form, and scenes.

mod closed_forms;
mod exact;
mod limits;
mod rays;
mod scenes;
