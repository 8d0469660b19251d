//! The slabs of a scene: crossings of surfaces made matter by the table of cases, `tables/slab.ron`.

use std::collections::HashMap;
use std::sync::Mutex;

use super::fine::{Fine, FineRow, Taken};
use super::functions::Function;
use super::inside::{Change, Changes};
use super::material::{Material, Through, Ways, ways};
use super::stack::Stack;
use super::surface::Surface;
use super::sweep::{Matter, Slabs};
use crate::diag::{Diagnostic, Failure, codes};
use crate::technique::tables::SLAB;

/// Policies of slabs: names of levels of `tables/policies.ron`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SlabPolicies {
    /// Of the set `coverage`.
    pub coverage: &'static str,
    /// Of the set `hit`.
    pub hit: &'static str,
}

/// A place to sample, of those in the level set `place` of `tables/slab.ron`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Nowhere,
    /// Within the matter that was there before the slab.
    Within,
    /// At a crossing, or at the hit of several.
    AtSurface,
    /// In the longest part inside, or the only one.
    InPart,
}

/// The table's word on a slab.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Case {
    inside_after: bool,
    place: Place,
    /// Set if a surface is seen in it.
    surface: bool,
}

/// Crossings of which cases are kept; more are rare, and asked for each time.
const KEPT: usize = 8;

/// The slabs of a scene.
#[derive(Debug)]
pub struct SceneSlabs<'c> {
    changes: &'c Changes,
    stack: &'c Stack,
    width: usize,
    policies: SlabPolicies,
    /// One for each object.
    materials: Vec<Material>,
    cases: Vec<[Case; 2]>,
    slab: Function,
    ways: Ways,
    fine: Option<Fine>,
    /// Opacity and transmittance by material and length of the way.
    known: Mutex<HashMap<(usize, u64), Through>>,
}

/// The pixels of a row between slabs.
#[derive(Debug)]
pub struct Row {
    cursors: Vec<Cursor>,
    fine: Option<Box<FineRow>>,
}

/// A pixel between slabs.
#[derive(Debug, Clone, Copy)]
pub struct Cursor {
    /// The next change of the pixel.
    next: usize,
    /// Set inside of matter.
    inside: bool,
    /// The object of which that matter is.
    medium: usize,
}

impl<'c> SceneSlabs<'c> {
    /// The slabs of a picture.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub(super) fn new(
        changes: &'c Changes,
        stack: &'c Stack,
        width: usize,
        policies: SlabPolicies,
        materials: Vec<Material>,
        fine: Option<Fine>,
    ) -> Result<Self, Failure> {
        let slab = Function::cases(&SLAB)?;
        let both = |crossings: usize| -> Result<[Case; 2], Failure> {
            let case = |inside: bool| case(slab, inside, crossings, policies.coverage);
            Ok([case(false)?, case(true)?])
        };
        Ok(Self {
            changes,
            stack,
            width,
            policies,
            materials,
            cases: (0..KEPT).map(both).collect::<Result<_, Failure>>()?,
            slab,
            ways: ways()?,
            fine,
            known: Mutex::default(),
        })
    }

    /// Of each slab, whether it holds matter at any pixel.
    pub fn occupied(&self) -> Vec<bool> {
        let count = self.stack.count();
        let mut starts = vec![0_i64; count + 1];
        for pixel in 0..self.changes.first.len() - 1 {
            for pair in self.changes.of(pixel).chunks(2) {
                starts[self.stack.slab_of(pair[0].at.depth)] += 1;
                starts[pair.get(1).map_or(count, |end| self.stack.slab_of(end.at.depth) + 1)] -= 1;
            }
        }
        occupied(&starts)
    }

    fn case(&self, inside: bool, crossings: usize) -> Case {
        match self.cases.get(crossings) {
            Some(cases) => cases[usize::from(inside)],
            // The table was asked before, and answers to any number of crossings.
            None => case(self.slab, inside, crossings, self.policies.coverage).unwrap_or(self.cases[0][0]),
        }
    }

    /// Opacity and transmittance of a way through an object.
    fn through(&self, object: usize, path: f64) -> Through {
        let key = (object, path.to_bits());
        if let Some(known) = self.known.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get(&key) {
            return *known;
        }
        let through = self.ways.of(&self.materials[object].matter, path);
        let mut known = self.known.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        // Ways of exactly the same length are those of whole slabs and of flat faces: others need not be kept.
        if known.len() < 1 << 16 {
            known.insert(key, through);
        }
        through
    }

    /// The length of the parts inside, and of the longest of them the object and the ends.
    fn parts(&self, cursor: &Cursor, changes: &[Change], (front, back): (f64, f64)) -> (f64, usize, [f64; 2]) {
        let (mut from, mut inside, mut medium) = (front, cursor.inside, cursor.medium);
        let (mut sum, mut longest, mut of, mut part) = (0.0, 0.0, cursor.medium, [front; 2]);
        let ends = changes
            .iter()
            .map(|change| (f64::from(change.at.depth).max(front), change.inside, change.at.object as usize));
        for (depth, inside_next, object) in ends.chain([(back, false, 0)]) {
            if inside {
                let length = depth - from;
                sum += length;
                if length > longest {
                    (longest, of, part) = (length, medium, [from, depth]);
                }
            }
            (from, inside, medium) = (depth, inside_next, object);
        }
        (sum, of, part)
    }

    /// The part that is taken of a slab, if there is any.
    fn taken(&self, cursor: &Cursor, changes: &[Change], case: Case, ends: (f64, f64)) -> Option<Taken> {
        let full = self.policies.coverage == "full";
        let hit = if self.policies.hit == "first" { changes.first() } else { changes.last() };
        let whole = self.stack.thickness;
        let (path, object, part) = match case.place {
            Place::Nowhere => return None,
            Place::Within => (whole, cursor.medium, [ends.0, ends.1]),
            Place::AtSurface | Place::InPart if full => {
                // Where the ray comes out, the matter is that which it was in.
                let object = hit.map_or(cursor.medium, |hit| hit.at.object as usize);
                let at = hit.map_or(ends.0, |hit| f64::from(hit.at.depth).max(ends.0));
                (whole, object, [at; 2])
            }
            Place::AtSurface | Place::InPart => self.parts(cursor, changes, ends),
        };
        let surface = hit.filter(|_| case.surface).map(|hit| Surface { normal: hit.at.normal, object });
        let ends = part.map(|end| end as f32);
        let jittered = full && case.place == Place::Within;
        let at = ends[0] + 0.5 * (ends[1] - ends[0]);
        (path > 0.0).then_some(Taken { object, path, ends, at, jittered, surface })
    }
}

/// Of each slab, whether it holds matter, from the changes of the number of pixels that do at its front.
pub(super) fn occupied(starts: &[i64]) -> Vec<bool> {
    let mut open = 0;
    starts[..starts.len() - 1].iter().map(|change| (open += change, open > 0).1).collect()
}

/// The case of a slab, from the table.
fn case(slab: Function, inside: bool, crossings: usize, coverage: &str) -> Result<Case, Failure> {
    let count = crossings.min(i32::MAX as usize).to_string();
    let inside_word = if inside { "true" } else { "false" };
    let answer = slab.call(&[
        ("inside", inside_word.into()),
        ("crossings", count.as_str().into()),
        ("coverage", coverage.into()),
    ])?;
    let place = match answer.level("sampled_at")? {
        "nowhere" => Place::Nowhere,
        "jittered" | "middle" => Place::Within,
        "crossing" | "hit" => Place::AtSurface,
        "inside_middle" | "longest_middle" => Place::InPart,
        other => {
            let message = format!("slabs are not sampled at `{other}`");
            return Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)));
        }
    };
    Ok(Case { inside_after: answer.holds("inside_after")?, place, surface: answer.holds("surface")? })
}

impl Slabs for SceneSlabs<'_> {
    type Row = Row;

    fn row(&self, y: usize) -> Row {
        let pixels = y * self.width..(y + 1) * self.width;
        let cursor = |pixel: usize| Cursor { next: self.changes.first[pixel], inside: false, medium: 0 };
        // The tables were asked before.
        let fine = self.fine.as_ref().and_then(|fine| fine.row().ok()).map(Box::new);
        Row { cursors: pixels.map(cursor).collect(), fine }
    }

    fn matter(&self, slab: usize, y: usize, row: &mut Row, out: &mut [Option<Matter>]) {
        let ends = self.stack.slab(slab);
        let mut detailed = Vec::new();
        for (x, (cursor, out)) in row.cursors.iter_mut().zip(out.iter_mut()).enumerate() {
            let end = self.changes.first[y * self.width + x + 1];
            let ahead = &self.changes.all[cursor.next..end];
            let changes = &ahead[..ahead.iter().take_while(|change| f64::from(change.at.depth) < ends.1).count()];
            let case = self.case(cursor.inside, changes.len());
            *out = None;
            match self.taken(cursor, changes, case, ends) {
                Some(taken) if self.fine.as_ref().is_some_and(|fine| fine.has(taken.object)) => {
                    detailed.push((x, taken));
                }
                Some(Taken { object, path, surface, .. }) => {
                    let (alpha, through) = self.through(object, path);
                    *out = Some(Matter { alpha, through, colour: self.materials[object].colour, surface });
                }
                None => {}
            }
            cursor.next += changes.len();
            cursor.inside = case.inside_after;
            if let Some(last) = changes.last() {
                cursor.medium = last.at.object as usize;
            }
        }
        if let (Some(fine), Some(row), false) = (&self.fine, &mut row.fine, detailed.is_empty()) {
            // The tables were asked before, and answer to any numbers.
            let filled = fine.fill(row, (slab, y), self.stack, &detailed, &self.materials, out);
            debug_assert!(filled.is_ok(), "{filled:?}");
        }
    }
}
