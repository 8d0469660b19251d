//! Results of techniques: named layers, a sample per pixel each.

/// A technique's answer for a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rendered {
    /// The layers, in the order in which they are to be shown.
    pub layers: Vec<Layer>,
}

/// A sample for every pixel, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// The layer's name.
    pub name: &'static str,
    /// Its samples.
    pub samples: Samples,
}

/// The samples of a layer.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// A number per pixel.
    Numbers(Vec<f32>),
    /// A count or an index per pixel.
    Counts(Vec<u32>),
    /// A colour per pixel, linear.
    Colours(Vec<[f32; 3]>),
}

/// Layer of the share of light that reaches a pixel, from 0 to 1.
pub const VALUE: &str = "value";
/// Layer of the light that a pixel sends to the camera.
pub const LIGHT: &str = "light";
/// Layer of the case of the table that was taken: its id, [`DEFAULT`] or [`NONE`].
pub const CASE: &str = "case";
/// Layer of the state that the table was evaluated in, as a number of its
/// [`StateSpace`](crate::program::StateSpace), or [`NONE`].
pub const STATE: &str = "state";
/// Layer of reads of a shadow map; a gather counts as one.
pub const READS: &str = "reads";
/// Layer of steps of loops.
pub const STEPS: &str = "steps";

/// In the layers [`CASE`] and [`STATE`]: no table was evaluated at the pixel.
pub const NONE: u32 = u32::MAX;
/// In the layer [`CASE`]: the table was evaluated, and none of its cases matched.
pub const DEFAULT: u32 = u32::MAX - 1;

impl Rendered {
    /// Adds a layer.
    #[must_use]
    pub fn with(mut self, name: &'static str, samples: Samples) -> Self {
        self.layers.push(Layer { name, samples });
        self
    }

    /// The samples of a layer.
    pub fn layer(&self, name: &str) -> Option<&Samples> {
        self.layers.iter().find(|layer| layer.name == name).map(|layer| &layer.samples)
    }

    /// The samples of a layer of numbers.
    pub fn numbers(&self, name: &str) -> Option<&[f32]> {
        match self.layer(name)? {
            Samples::Numbers(samples) => Some(samples),
            Samples::Counts(_) | Samples::Colours(_) => None,
        }
    }

    /// The samples of a layer of counts.
    pub fn counts(&self, name: &str) -> Option<&[u32]> {
        match self.layer(name)? {
            Samples::Counts(samples) => Some(samples),
            Samples::Numbers(_) | Samples::Colours(_) => None,
        }
    }

    /// The samples of a layer of colours.
    pub fn colours(&self, name: &str) -> Option<&[[f32; 3]]> {
        match self.layer(name)? {
            Samples::Colours(samples) => Some(samples),
            Samples::Numbers(_) | Samples::Counts(_) => None,
        }
    }
}
