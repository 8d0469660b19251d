//! Columns: what stands below each other in rows that follow each other.
//!
//! Three kinds of rows are always aligned: the values of inputs, names and
//! their like; the conditions of lines; and the fields of cases that take one
//! line each. Everywhere else what the author has aligned stays aligned.

use super::rows::{Line, OUTSIDE, Pair, Piece, Rows, is_section};
use crate::text::tokens::Kind;

/// Fields of a table whose entries are aligned.
const ALIGNED: [&str; 8] = ["levels", "inputs", "groups", "names", "symmetries", "assume", "continuity", "constants"];

/// Keys, and other cells, that are wider than others by more than this form a column of their own.
const NEAR: (usize, usize) = (6, 16);

/// The pieces of a row that begin a cell, with the name of its field if it has one.
type Stops = Vec<(usize, String)>;

/// A row that takes part in an alignment.
struct Row {
    line: usize,
    /// True if its only cell is the value of a key.
    keyed: bool,
    stops: Stops,
}

/// Sets the gaps of all pieces that stand in columns.
pub(super) fn align(rows: &mut Rows<'_>) {
    let Rows { lines, pairs } = rows;
    let mut run: Vec<Row> = Vec::new();
    let mut of = None;
    for index in 0..lines.len() {
        let line = &lines[index];
        let found = row(line, pairs);
        let begins = found.as_ref().is_some_and(|(pair, _, _)| of == Some(*pair));
        // Lines inside of an item are passed over; everything else ends a run.
        let inside = line.pieces.first().is_some_and(|piece| {
            of.is_some_and(|of| {
                !piece.begins_in(of, pairs) && !piece.token.is_comment() && is_inside(piece.pair, of, pairs)
            })
        });
        if line.blank || !(begins || inside) {
            finish(lines, &mut run);
            of = None;
        }
        if let Some((pair, stops, last)) = found {
            of = (!last).then_some(pair);
            run.push(Row { line: index, keyed: pairs[pair].open == '{', stops });
            if last {
                finish(lines, &mut run);
            }
        }
    }
    finish(lines, &mut run);
    keep(lines, pairs);
}

impl Piece<'_> {
    /// The pair that it stands in. A bracket counts itself to what it opens.
    fn around(&self, pairs: &[Pair]) -> usize {
        if self.token.kind == Kind::Open { pairs[self.pair].parent } else { self.pair }
    }

    /// Returns whether an item of a pair begins with it.
    fn begins_in(&self, pair: usize, pairs: &[Pair]) -> bool {
        self.begins && self.around(pairs) == pair
    }
}

fn is_inside(mut pair: usize, outer: usize, pairs: &[Pair]) -> bool {
    while pair != OUTSIDE {
        if pairs[pair].parent == outer {
            return true;
        }
        pair = pairs[pair].parent;
    }
    false
}

/// The pair whose item begins on a line that is a row, the cells, and whether no row can follow.
fn row(line: &Line<'_>, pairs: &[Pair]) -> Option<(usize, Stops, bool)> {
    let first = line.pieces.first()?;
    if !first.begins {
        return None;
    }
    let pair = first.around(pairs);
    let (open, field) = (pairs[pair].open, pairs[pair].field.as_str());
    let last = line.pieces.iter().rfind(|piece| !piece.token.is_comment())?;
    if line.pieces.iter().skip(1).any(|piece| piece.begins_in(pair, pairs)) {
        return None;
    }
    if open == '{' && is_section(pairs, pair) && ALIGNED.contains(&field) {
        // A comment to the end of the line is no value: where it stands is decided among comments.
        let is_value =
            |piece: &&Piece<'_>| line.pieces[1].token.kind == Kind::Colon && piece.token.kind != Kind::LineComment;
        let value = line.pieces.get(2).filter(is_value);
        let stops = value.map(|_| (2, String::new())).into_iter().collect();
        return Some((pair, stops, last.token.kind == Kind::Open));
    }
    let of_lines = open == '[' && (field == "lines" || pairs[pairs[pair].parent].field == "helpers");
    let of_cases = open == '[' && field == "cases";
    if !of_lines && !of_cases {
        return None;
    }
    let Some(bracket) = line.pieces.iter().position(|piece| piece.token.kind == Kind::Open).filter(|i| *i <= 1) else {
        return Some((pair, Vec::new(), false));
    };
    let own = line.pieces[bracket].pair;
    let closed = line.pieces.iter().any(|piece| piece.token.kind == Kind::Close && piece.pair == own);
    if !closed {
        return Some((pair, Vec::new(), true));
    }
    let cells = line.pieces.iter().enumerate().skip(bracket + 2);
    let cells = cells.filter(|(_, piece)| piece.begins_in(own, pairs));
    let named = |index: usize| if of_cases { line.pieces[index].token.text.to_owned() } else { String::new() };
    Some((pair, cells.map(|(index, _)| (index, named(index))).collect(), false))
}

/// Aligns the rows of a run, column by column, and forgets them.
fn finish(lines: &mut [Line<'_>], run: &mut Vec<Row>) {
    let columns = run.iter().map(|row| row.stops.len()).max().unwrap_or(0);
    for row in run.iter() {
        for (index, _) in &row.stops {
            lines[row.line].pieces[*index].ruled = true;
        }
    }
    for column in 0..columns {
        let mut open: Vec<&Row> = run.iter().filter(|row| row.stops.len() > column).collect();
        while let Some(first) = open.first().copied() {
            let same =
                |row: &Row| row.stops[..=column].iter().zip(&first.stops[..=column]).all(|((_, a), (_, b))| a == b);
            let group: Vec<(usize, usize)> =
                open.iter().filter(|row| same(row)).map(|row| (row.line, row.stops[column].0)).collect();
            open.retain(|row| !same(row));
            columns_of_near(lines, &group, if first.keyed { NEAR.0 } else { NEAR.1 });
        }
    }
    run.clear();
}

/// Aligns pieces, those far wider than others apart from these.
fn columns_of_near(lines: &mut [Line<'_>], group: &[(usize, usize)], near: usize) {
    let mut ends: Vec<(usize, usize, usize)> =
        group.iter().filter_map(|(line, piece)| Some((end_before(&lines[*line], *piece)?, *line, *piece))).collect();
    ends.sort_unstable();
    let mut start = 0;
    for index in 0..ends.len() {
        let next = ends.get(index + 1);
        if next.is_some_and(|next| next.0 <= ends[index].0 + near) {
            continue;
        }
        for (end, line, piece) in &ends[start..=index] {
            lines[*line].pieces[*piece].gap = ends[index].0 + 1 - end;
        }
        start = index + 1;
    }
}

/// The end of the piece before one, counted from the start of the line; none after a text of several lines.
fn end_before(line: &Line<'_>, piece: usize) -> Option<usize> {
    let mut end = 0;
    for (index, piece) in line.pieces[..piece].iter().enumerate() {
        end += if index == 0 { 0 } else { piece.gap } + piece.written.width()?;
    }
    Some(end)
}

/// Keeps columns that the author has made, paragraph by paragraph.
fn keep(lines: &mut [Line<'_>], pairs: &[Pair]) {
    let mut start = 0;
    for end in 1..=lines.len() {
        if lines.get(end).is_none_or(|line| line.blank) {
            keep_in(&mut lines[start..end], pairs);
            start = end;
        }
    }
}

fn keep_in(lines: &mut [Line<'_>], pairs: &[Pair]) {
    // Where a column is meant: a piece with more than one blank in front of it.
    let mut meant: Vec<(usize, usize)> = Vec::new();
    for line in lines.iter() {
        for (index, piece) in line.pieces.iter().enumerate().skip(1) {
            if piece.token.gap > 1 && is_cell(line, index) {
                meant.extend(starts_in(line, pairs).map(|pair| (piece.token.column, pair)));
            }
        }
    }
    meant.sort_unstable();
    meant.dedup();
    for (column, pair) in meant {
        let mut members: Vec<(usize, usize, usize)> = Vec::new();
        for (number, line) in lines.iter().enumerate().filter(|(_, line)| starts_in(line, pairs) == Some(pair)) {
            let here =
                line.pieces.iter().enumerate().skip(1).find(|(index, piece)| {
                    piece.token.column == column && piece.token.gap > 0 && is_cell(line, *index)
                });
            if let Some((index, _)) = here
                && let Some(end) = end_before(line, index)
            {
                members.push((number, index, end));
            }
        }
        let widest = members.iter().map(|(_, _, end)| *end).max().unwrap_or(0);
        if members.len() > 1 {
            for (number, index, end) in members {
                lines[number].pieces[index].gap = widest + 1 - end;
            }
        }
    }
}

/// The pair whose item begins with the line: lines of one pair are indented alike.
fn starts_in(line: &Line<'_>, pairs: &[Pair]) -> Option<usize> {
    line.pieces.first().filter(|first| first.begins).map(|first| first.around(pairs))
}

/// Returns whether a piece begins a cell whose place the author decides.
fn is_cell(line: &Line<'_>, index: usize) -> bool {
    let (before, piece) = (&line.pieces[index - 1], &line.pieces[index]);
    !piece.ruled && !piece.token.is_comment() && matches!(before.token.kind, Kind::Comma | Kind::Colon)
}
