//! Inside and outside: of a pixel's crossings those at which a ray goes in or comes out.

use std::collections::HashMap;

use super::functions::Function;
use super::layers::{Crossing, Layers};
use crate::diag::{Diagnostic, Failure, codes};
use crate::technique::tables::POLICIES;

/// A place at which a ray goes into matter or comes out of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The surface.
    pub at: Crossing,
    /// Set if there is matter behind it.
    pub inside: bool,
}

/// The changes of all pixels.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    /// The place in `all` at which each pixel's list begins, and the end of the last one.
    pub first: Vec<usize>,
    /// The lists, one behind the other.
    pub all: Vec<Change>,
    /// The pixels whose list ended inside, with 1.
    pub odd: Vec<bool>,
}

/// The rule that separates inside from outside, and the fate of a list that ends inside: names of levels of
/// `tables/policies.ron`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InsideRule {
    /// Of the set `rule`.
    pub rule: &'static str,
    /// Of the set `odd_list`.
    pub odd_list: &'static str,
}

/// The table's function of one crossing, with what it said so far.
struct Crossed {
    function: Function,
    rule: &'static str,
    known: HashMap<(i64, bool), (i64, bool)>,
}

impl Crossed {
    /// The count that is carried on, and whether it is inside.
    fn next(&mut self, wound: i64, enters: bool) -> Result<(i64, bool), Failure> {
        if let Some(known) = self.known.get(&(wound, enters)) {
            return Ok(*known);
        }
        let enters_word = if enters { "true" } else { "false" };
        let answer = self.function.call(&[
            ("inside_rule", self.rule.into()),
            ("wound", (wound as f64).into()),
            ("enters", enters_word.into()),
        ])?;
        let next = (answer.number("wound")? as i64, answer.holds("inside")?);
        self.known.insert((wound, enters), next);
        Ok(next)
    }
}

impl Changes {
    /// The changes between inside and outside of a picture's layers.
    ///
    /// # Errors
    /// When a list ends inside and that is not to be.
    pub fn new(layers: &Layers, rule: InsideRule) -> Result<Self, Failure> {
        let function = Function::of(&POLICIES, "crossed")?;
        let mut crossed = Crossed { function, rule: rule.rule, known: HashMap::new() };
        let pixels = layers.first.len().saturating_sub(1);
        let mut changes = Self { first: vec![0], all: Vec::with_capacity(layers.crossings.len()), odd: Vec::new() };
        for pixel in 0..pixels {
            let (mut wound, mut inside) = (0, false);
            for at in layers.of(pixel) {
                let (next, now) = crossed.next(wound, at.front)?;
                if now != inside {
                    changes.all.push(Change { at: *at, inside: now });
                }
                (wound, inside) = (next, now);
            }
            if inside && rule.odd_list == "drop_last" {
                changes.all.pop();
            }
            changes.odd.push(inside);
            changes.first.push(changes.all.len());
        }
        refuse_odd(changes.odd.iter().filter(|odd| **odd).count(), pixels, rule)?;
        Ok(changes)
    }

    /// The changes of a pixel.
    pub fn of(&self, pixel: usize) -> &[Change] {
        &self.all[self.first[pixel]..self.first[pixel + 1]]
    }
}

/// Refuses lists that end inside, if they are not to be.
pub(super) fn refuse_odd(odd: usize, pixels: usize, rule: InsideRule) -> Result<(), Failure> {
    if odd == 0 || rule.odd_list != "error" {
        return Ok(());
    }
    let message = format!("at {odd} of {pixels} pixels a surface is entered and never left");
    let error = Diagnostic::error(codes::RENDER, message).help("close the meshes of the scene");
    let others = "or choose what becomes of them: `--set odd=drop_last` or `--set odd=close_at_end`";
    Err(Failure::bare("", error.help(others)))
}
