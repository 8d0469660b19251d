//! Answers to what a state leaves open, the same question always the same way; and all answers in turn.
//!
//! A comparison whose outcome follows from others on the same path is no question, so that numbers that are
//! compared with many constants have as many paths as there are intervals between these.

use std::collections::HashMap;

use crate::program::comparisons::Comparisons;
use crate::program::{Comparison, ExprId, InputId, Pool, Program};

/// A fact that a state leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Question {
    Level(InputId),
    Compare(Comparison, ExprId, ExprId),
}

/// A question that was asked.
pub(super) struct Choice {
    pub(super) question: Question,
    pub(super) answer: u8,
    /// The number of answers.
    count: u8,
    /// The answers to comparisons before this one.
    before: Comparisons,
}

/// Answers questions, the same one always the same way, until told to advance.
#[derive(Default)]
pub(super) struct Oracle {
    /// Level by input; fetched inputs are set when first asked.
    pub(super) levels: Vec<u8>,
    /// Questions asked so far.
    pub(super) choices: Vec<Choice>,
    /// The answers to comparisons.
    compared: Comparisons,
    /// The place of each question among them.
    asked: HashMap<Question, usize>,
    /// Questions answered in this state so far.
    pub(super) answered: usize,
}

impl Oracle {
    pub(super) fn new(program: &Program) -> Self {
        Self { levels: vec![0; program.inputs.len()], ..Self::default() }
    }

    pub(super) fn answer(&mut self, question: Question, count: u8) -> u8 {
        self.answered += 1;
        if let Some(answer) = self.known(question) {
            return answer;
        }
        self.asked.insert(question, self.choices.len());
        self.choices.push(Choice { question, answer: 0, count, before: self.compared.clone() });
        0
    }

    /// The outcome of a comparison, which may follow from others.
    pub(super) fn compare(&mut self, pool: &Pool, op: Comparison, a: ExprId, b: ExprId) -> bool {
        if let Some(holds) = self.compared(pool, op, a, b) {
            self.answered += 1;
            return holds;
        }
        let holds = self.answer(Question::Compare(op, a, b), 2) == 0;
        self.compared.learn(pool, op, a, b, holds);
        holds
    }

    /// The outcome of a comparison, if this path has decided that already.
    pub(super) fn compared(&self, pool: &Pool, op: Comparison, a: ExprId, b: ExprId) -> Option<bool> {
        let asked = self.known(Question::Compare(op, a, b)).map(|answer| answer == 0);
        asked.or_else(|| self.compared.decide(pool, op, a, b))
    }

    /// The answer on this path, if the question was asked.
    pub(super) fn known(&self, question: Question) -> Option<u8> {
        self.asked.get(&question).map(|place| self.choices[*place].answer)
    }

    /// Forgets all paths.
    pub(super) fn restart(&mut self) {
        self.choices.clear();
        self.compared = Comparisons::default();
        self.asked.clear();
        self.answered = 0;
    }

    /// Moves on to the next sequence of answers; false if that was the last.
    pub(super) fn advance(&mut self, pool: &Pool) -> bool {
        while let Some(choice) = self.choices.last_mut() {
            choice.answer += 1;
            if choice.answer < choice.count {
                self.compared = choice.before.clone();
                if let Question::Compare(op, a, b) = choice.question {
                    self.compared.learn(pool, op, a, b, choice.answer == 0);
                }
                return true;
            }
            self.asked.remove(&choice.question);
            self.choices.pop();
        }
        false
    }
}
