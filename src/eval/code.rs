//! Straight-line code over columns: what the leaves and comparisons of a
//! residual tree become.
//!
//! A register holds one number for each row of a block. An operation runs over
//! whole registers, so its dispatch is paid once per block and its loop
//! vectorises. Every element goes through [`Real`], like in the reference.

use std::collections::HashMap;

use super::columns::{Column, Columns};
use super::residual::{Term, TermId, Test};
use crate::program::{BinaryOp, Comparison, InputId, Real, TernaryOp, UnaryOp};

/// Most rows that go through an instruction at once: a few registers of this fit the first-level cache.
pub(super) const BLOCK: usize = 1024;

/// An operand of an instruction.
#[derive(Debug, Clone, Copy)]
pub(super) enum Operand<T> {
    Register(usize),
    Const(T),
}

#[derive(Debug, Clone, Copy)]
enum Instruction<T> {
    Load(InputId),
    Unary(UnaryOp, Operand<T>),
    Binary(BinaryOp, Operand<T>, Operand<T>),
    Ternary(TernaryOp, Operand<T>, Operand<T>, Operand<T>),
    Compare(Test, Operand<T>, Operand<T>),
    Choose(Operand<T>, Operand<T>, Operand<T>),
}

/// Code that computes some terms.
#[derive(Debug, Clone)]
pub(super) struct Code<T> {
    /// Each writes the register beside it, which is never one it reads.
    instructions: Vec<(usize, Instruction<T>)>,
    /// The places of the terms afterwards.
    pub(super) outputs: Vec<Operand<T>>,
    registers: usize,
}

impl<T: Real> Code<T> {
    /// Compiles `roots`.
    pub(super) fn new(terms: &[Term], roots: &[TermId]) -> Self {
        let mut compiler = Compiler { terms, code: Vec::new(), places: HashMap::new(), registers: 0 };
        let outputs = roots.iter().map(|root| compiler.place(*root)).collect();
        let (instructions, registers) = (compiler.code, compiler.registers);
        Self { instructions, outputs, registers }.with_registers_reused()
    }

    /// Renames registers so that one is used again after its last reader.
    fn with_registers_reused(mut self) -> Self {
        const FOREVER: usize = usize::MAX;
        let mut last_use = vec![0; self.registers];
        for (at, (_, instruction)) in self.instructions.iter_mut().enumerate() {
            instruction.operands(|register| last_use[*register] = at);
        }
        for output in &self.outputs {
            if let Operand::Register(register) = output {
                last_use[*register] = FOREVER;
            }
        }
        let (mut names, mut free, mut count) = (vec![0; self.registers], Vec::new(), 0);
        for (at, (target, instruction)) in self.instructions.iter_mut().enumerate() {
            // Before its operands are freed: an instruction must not write what it reads.
            let name = free.pop().unwrap_or_else(|| {
                count += 1;
                count - 1
            });
            instruction.operands(|register| {
                let name = names[*register];
                if last_use[*register] == at {
                    // An operand that occurs twice is freed once.
                    last_use[*register] = FOREVER;
                    free.push(name);
                }
                *register = name;
            });
            names[*target] = name;
            *target = name;
        }
        for output in &mut self.outputs {
            if let Operand::Register(register) = output {
                *register = names[*register];
            }
        }
        self.registers = count;
        self
    }

    /// Runs the code for the rows `start + rows[..]`; at most [`BLOCK`] of them.
    pub(super) fn run(&self, columns: &Columns<T>, start: usize, rows: &[u16], registers: &mut Registers<T>) {
        let len = rows.len();
        registers.reserve(self.registers);
        for (target, instruction) in &self.instructions {
            let mut target_register = std::mem::take(&mut registers.0[*target]);
            let out = &mut target_register[..len];
            match *instruction {
                Instruction::Load(input) => match columns.column(input) {
                    Column::Numbers { values, .. } => {
                        let values = &values[start..];
                        for (out, row) in out.iter_mut().zip(rows) {
                            *out = values[usize::from(*row)];
                        }
                    }
                    Column::Levels(levels) => {
                        let levels = &levels[start..];
                        for (out, row) in out.iter_mut().zip(rows) {
                            *out = T::from_f64(f64::from(levels[usize::from(*row)]));
                        }
                    }
                },
                Instruction::Unary(op, a) => unary(op, out, registers.argument(a, len)),
                Instruction::Binary(op, a, b) => {
                    binary(op, out, registers.argument(a, len), registers.argument(b, len));
                }
                Instruction::Ternary(op, a, b, c) => {
                    let [a, b, c] = [a, b, c].map(|operand| registers.argument(operand, len));
                    ternary(op, out, a, b, c);
                }
                Instruction::Compare(test, a, b) => {
                    compare(test, out, registers.argument(a, len), registers.argument(b, len));
                }
                Instruction::Choose(condition, a, b) => {
                    let [condition, a, b] = [condition, a, b].map(|operand| registers.argument(operand, len));
                    let no = T::from_f64(0.0);
                    map3(out, condition, a, b, |condition, a, b| if condition == no { b } else { a });
                }
            }
            registers.0[*target] = target_register;
        }
    }
}

impl<T> Instruction<T> {
    fn operands(&mut self, mut visit: impl FnMut(&mut usize)) {
        let mut each = |operand: &mut Operand<T>| {
            if let Operand::Register(register) = operand {
                visit(register);
            }
        };
        match self {
            Instruction::Load(_) => {}
            Instruction::Unary(_, a) => each(a),
            Instruction::Binary(_, a, b) | Instruction::Compare(_, a, b) => [a, b].into_iter().for_each(each),
            Instruction::Ternary(_, a, b, c) | Instruction::Choose(a, b, c) => [a, b, c].into_iter().for_each(each),
        }
    }
}

struct Compiler<'a, T> {
    terms: &'a [Term],
    code: Vec<(usize, Instruction<T>)>,
    places: HashMap<TermId, usize>,
    registers: usize,
}

impl<T: Real> Compiler<'_, T> {
    fn place(&mut self, term: TermId) -> Operand<T> {
        if let Some(register) = self.places.get(&term) {
            return Operand::Register(*register);
        }
        let instruction = match self.terms[term.index()] {
            Term::Const(number) => return Operand::Const(T::from_f64(number.get())),
            Term::Word(word) => return Operand::Const(T::from_word(word)),
            Term::Input(input) | Term::Index(input) => Instruction::Load(input),
            Term::Unary(op, a) => Instruction::Unary(op, self.place(a)),
            Term::Binary(op, a, b) => Instruction::Binary(op, self.place(a), self.place(b)),
            Term::Ternary(op, a, b, c) => Instruction::Ternary(op, self.place(a), self.place(b), self.place(c)),
            Term::Compare(test, a, b) => Instruction::Compare(test, self.place(a), self.place(b)),
            Term::Choose(condition, a, b) => Instruction::Choose(self.place(condition), self.place(a), self.place(b)),
        };
        let register = self.registers;
        self.registers += 1;
        self.places.insert(term, register);
        self.code.push((register, instruction));
        Operand::Register(register)
    }
}

/// Registers of [`BLOCK`] numbers each.
#[derive(Debug)]
pub(super) struct Registers<T>(Vec<Vec<T>>);

impl<T: Real> Registers<T> {
    pub(super) fn new() -> Self {
        Self(Vec::new())
    }

    fn reserve(&mut self, count: usize) {
        while self.0.len() < count {
            self.0.push(vec![T::from_f64(0.0); BLOCK]);
        }
    }

    /// The first `len` numbers of an operand.
    pub(super) fn argument(&self, operand: Operand<T>, len: usize) -> Argument<'_, T> {
        match operand {
            Operand::Register(register) => Argument::Each(&self.0[register][..len]),
            Operand::Const(value) => Argument::Same(value),
        }
    }
}

/// An operand with its numbers.
#[derive(Debug, Clone, Copy)]
pub(super) enum Argument<'a, T> {
    Each(&'a [T]),
    Same(T),
}

impl<T: Copy> Argument<'_, T> {
    /// The number in a row.
    pub(super) fn at(self, row: usize) -> T {
        match self {
            Argument::Each(values) => values[row],
            Argument::Same(value) => value,
        }
    }
}

#[inline(always)]
fn map<T: Copy>(out: &mut [T], a: Argument<'_, T>, f: impl Fn(T) -> T) {
    match a {
        Argument::Each(a) => out.iter_mut().zip(a).for_each(|(out, a)| *out = f(*a)),
        Argument::Same(a) => out.fill(f(a)),
    }
}

#[inline(always)]
fn map2<T: Copy>(out: &mut [T], a: Argument<'_, T>, b: Argument<'_, T>, f: impl Fn(T, T) -> T) {
    match (a, b) {
        (Argument::Each(a), Argument::Each(b)) => {
            out.iter_mut().zip(a).zip(b).for_each(|((out, a), b)| *out = f(*a, *b));
        }
        (Argument::Each(_), Argument::Same(b)) => map(out, a, |a| f(a, b)),
        (Argument::Same(a), _) => map(out, b, |b| f(a, b)),
    }
}

#[inline(always)]
fn map3<T: Copy>(out: &mut [T], a: Argument<'_, T>, b: Argument<'_, T>, c: Argument<'_, T>, f: impl Fn(T, T, T) -> T) {
    match (b, c) {
        (Argument::Same(b), Argument::Same(c)) => map(out, a, |a| f(a, b, c)),
        _ => out.iter_mut().enumerate().for_each(|(row, out)| *out = f(a.at(row), b.at(row), c.at(row))),
    }
}

// With the operation a literal, each arm becomes a loop of its own without dispatch inside.

#[allow(clippy::wildcard_enum_match_arm, reason = "the arms with a literal are for speed and change no result")]
fn unary<T: Real>(op: UnaryOp, out: &mut [T], a: Argument<'_, T>) {
    match op {
        UnaryOp::Negate => map(out, a, |a| T::unary(UnaryOp::Negate, a)),
        UnaryOp::Abs => map(out, a, |a| T::unary(UnaryOp::Abs, a)),
        UnaryOp::Saturate => map(out, a, |a| T::unary(UnaryOp::Saturate, a)),
        UnaryOp::Sqrt => map(out, a, |a| T::unary(UnaryOp::Sqrt, a)),
        _ => map(out, a, |a| T::unary(op, a)),
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "the arms with a literal are for speed and change no result")]
fn binary<T: Real>(op: BinaryOp, out: &mut [T], a: Argument<'_, T>, b: Argument<'_, T>) {
    match op {
        BinaryOp::Add => map2(out, a, b, |a, b| T::binary(BinaryOp::Add, a, b)),
        BinaryOp::Subtract => map2(out, a, b, |a, b| T::binary(BinaryOp::Subtract, a, b)),
        BinaryOp::Multiply => map2(out, a, b, |a, b| T::binary(BinaryOp::Multiply, a, b)),
        BinaryOp::Divide => map2(out, a, b, |a, b| T::binary(BinaryOp::Divide, a, b)),
        BinaryOp::Max => map2(out, a, b, |a, b| T::binary(BinaryOp::Max, a, b)),
        BinaryOp::Min => map2(out, a, b, |a, b| T::binary(BinaryOp::Min, a, b)),
        BinaryOp::Step => map2(out, a, b, |a, b| T::binary(BinaryOp::Step, a, b)),
        _ => map2(out, a, b, |a, b| T::binary(op, a, b)),
    }
}

fn compare<T: Real>(test: Test, out: &mut [T], a: Argument<'_, T>, b: Argument<'_, T>) {
    let [no, yes] = [0.0, 1.0].map(T::from_f64);
    let truth = |holds: bool| if holds { yes } else { no };
    match test {
        Test { op: Comparison::Less, words: false } => map2(out, a, b, |a, b| truth(a < b)),
        Test { op: Comparison::LessEqual, words: false } => map2(out, a, b, |a, b| truth(a <= b)),
        Test { op: Comparison::Equal, words: false } => map2(out, a, b, |a, b| truth(a == b)),
        Test { words: true, .. } => map2(out, a, b, |a, b| truth(test.holds(a, b))),
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "the arms with a literal are for speed and change no result")]
fn ternary<T: Real>(op: TernaryOp, out: &mut [T], a: Argument<'_, T>, b: Argument<'_, T>, c: Argument<'_, T>) {
    match op {
        TernaryOp::Clamp => map3(out, a, b, c, |a, b, c| T::ternary(TernaryOp::Clamp, a, b, c)),
        TernaryOp::Mix => map3(out, a, b, c, |a, b, c| T::ternary(TernaryOp::Mix, a, b, c)),
        _ => map3(out, a, b, c, |a, b, c| T::ternary(op, a, b, c)),
    }
}
