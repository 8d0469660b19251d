//! The best order of a chain of tests.
//!
//! A test is passed by everything that is found behind it, so what is common
//! should stand in front: the expected number of tests is the sum of weight
//! times place. Some must stay behind others; then this is the scheduling of
//! unit jobs with precedence on one machine, which is hard in general and
//! small here. Many pairs can be decided beforehand; then dynamic programming
//! over the sets of tests that can stand in front, with the order that ignores
//! precedence as its bound, finds the optimum or says by how much it may have
//! missed it.

use std::collections::HashMap;
use std::fmt;

/// Most sets of tests that the search looks at.
const MAX_SETS: usize = 1 << 19;
/// Most tests whose sets fit a mask.
const MAX_EXACT: usize = 64;

/// The cost of an order, and a bound on the best one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// Expected number of tests in the order written.
    pub written: f64,
    /// Expected number of tests as planned.
    pub planned: f64,
    /// No plan of this shape takes fewer.
    pub bound: f64,
}

impl Certificate {
    /// Returns whether no plan of this shape is better.
    pub fn is_optimal(&self) -> bool {
        self.planned - self.bound <= 1e-9 * self.planned.max(1.0)
    }
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected tests {:.3}, as written {:.3}; ", self.planned, self.written)?;
        match self.is_optimal() {
            true => f.write_str("optimal"),
            false => write!(f, "at most {:.3} more than the optimum", self.planned - self.bound),
        }
    }
}

/// Tests that are to be put in order.
#[derive(Debug, Clone)]
pub(super) struct Tests {
    /// The share of evaluations that end at each.
    pub(super) weights: Vec<f64>,
    /// Those that each must stay behind.
    pub(super) before: Vec<Vec<usize>>,
    /// The share of evaluations that pass all of them.
    pub(super) passed: f64,
}

impl Tests {
    /// The expected number of tests in an order.
    pub(super) fn cost(&self, order: &[usize]) -> f64 {
        let placed: f64 = order.iter().zip(1..).map(|(test, place)| self.weights[*test] * f64::from(place)).sum();
        placed + self.passed * order.len() as f64
    }

    /// The best order that is found, and a bound of what any order costs.
    pub(super) fn best(&self) -> (Vec<usize>, f64) {
        let greedy = self.greedy();
        if self.weights.len() > MAX_EXACT {
            let bound = self.relaxed(|_| true) + self.passed * self.weights.len() as f64;
            return (greedy, bound);
        }
        let known = self.cost(&greedy);
        match Search::new(self).run(known) {
            Ok(better) => {
                let order = better.unwrap_or(greedy);
                let cost = self.cost(&order);
                (order, cost)
            }
            Err(bound) => (greedy, bound),
        }
    }

    /// Takes, again and again, the tests that lead most cheaply to much weight.
    fn greedy(&self) -> Vec<usize> {
        let count = self.weights.len();
        let mut after = vec![Vec::new(); count];
        let mut waiting = vec![0; count];
        for (test, before) in self.before.iter().enumerate() {
            waiting[test] = before.len();
            before.iter().for_each(|first| after[*first].push(test));
        }
        // What a test makes possible counts as well, the less the more there is of it.
        let mut reach = self.weights.clone();
        for test in (0..count).rev() {
            for next in &after[test] {
                reach[test] = reach[test].max((self.weights[test] + reach[*next]) / 2.0);
            }
        }
        let mut free: std::collections::BinaryHeap<(Rank, std::cmp::Reverse<usize>)> = (0..count)
            .filter(|test| waiting[*test] == 0)
            .map(|test| (Rank(reach[test]), std::cmp::Reverse(test)))
            .collect();
        let mut order = Vec::with_capacity(count);
        while let Some((_, std::cmp::Reverse(test))) = free.pop() {
            order.push(test);
            for next in &after[test] {
                waiting[*next] -= 1;
                if waiting[*next] == 0 {
                    free.push((Rank(reach[*next]), std::cmp::Reverse(*next)));
                }
            }
        }
        order
    }

    /// The cost of the tests in the order of their weights, from place 1 on.
    fn relaxed(&self, is_in: impl Fn(usize) -> bool) -> f64 {
        let mut weights: Vec<f64> = (0..self.weights.len()).filter(|t| is_in(*t)).map(|t| self.weights[t]).collect();
        weights.sort_by(|a, b| b.total_cmp(a));
        weights.iter().zip(1..).map(|(weight, place)| weight * f64::from(place)).sum()
    }
}

/// Weights in an order.
#[derive(Clone, Copy, PartialEq)]
struct Rank(f64);

impl Eq for Rank {}

impl PartialOrd for Rank {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rank {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Looks at the sets of tests that can stand in front, the small ones first.
struct Search<'t> {
    tests: &'t Tests,
    /// Those that each must stay behind, as masks; all of them, not only the nearest.
    before: Vec<u64>,
    /// Those that must stay behind each.
    after: Vec<u64>,
    /// By weight, the heaviest first.
    sorted: Vec<usize>,
}

/// The cheapest way to a set in front.
#[derive(Clone, Copy)]
struct Way {
    cost: f64,
    last: usize,
}

impl<'t> Search<'t> {
    fn new(tests: &'t Tests) -> Self {
        let count = tests.weights.len();
        let mut sorted: Vec<usize> = (0..count).collect();
        sorted.sort_by(|a, b| tests.weights[*b].total_cmp(&tests.weights[*a]).then(a.cmp(b)));
        let mut search = Self { tests, before: vec![0; count], after: vec![0; count], sorted };
        for (test, before) in tests.before.iter().enumerate() {
            before.iter().for_each(|first| search.put(*first, test));
        }
        search.decide_pairs();
        search
    }

    /// Lets one test stay before another, with what follows from that.
    fn put(&mut self, first: usize, then: usize) {
        let front = self.before[first] | 1 << first;
        let back = self.after[then] | 1 << then;
        for test in 0..self.before.len() {
            if back >> test & 1 == 1 {
                self.before[test] |= front;
            }
            if front >> test & 1 == 1 {
                self.after[test] |= back;
            }
        }
    }

    /// Decides between two tests wherever one is no lighter, waits for nothing that the other
    /// does not wait for, and keeps all those waiting that the other does: exchanging them in an
    /// order that has them the other way round breaks no precedence and costs nothing.
    fn decide_pairs(&mut self) {
        let count = self.before.len();
        loop {
            let mut changed = false;
            for place in 0..count {
                for other in 0..count {
                    let (first, then) = (self.sorted[place], self.sorted[other]);
                    let decided = self.before[then] >> first & 1 == 1 || self.before[first] >> then & 1 == 1;
                    let heavier = self.tests.weights[first] >= self.tests.weights[then];
                    if first != then
                        && !decided
                        && heavier
                        && self.before[first] & !self.before[then] == 0
                        && self.after[then] & !self.after[first] == 0
                    {
                        self.put(first, then);
                        changed = true;
                    }
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// The least cost of a beginning when it is completed, all other tests in the order of their weights.
    fn at_least(&self, front: u64, cost: f64, placed: usize) -> f64 {
        let rest = self.sorted.iter().filter(|test| front >> **test & 1 == 0);
        let rest: f64 = rest.zip(placed + 1..).map(|(test, place)| self.tests.weights[*test] * place as f64).sum();
        cost + rest + self.tests.passed * self.tests.weights.len() as f64
    }

    /// The best order, if it costs less than `best` and the sets are few enough to tell; else what any order costs.
    fn run(&self, best: f64) -> std::result::Result<Option<Vec<usize>>, f64> {
        let count = self.before.len();
        let mut layers: Vec<HashMap<u64, Way>> = vec![HashMap::from([(0, Way { cost: 0.0, last: 0 })])];
        let mut sets = 1;
        for placed in 0..count {
            let place = (placed + 1) as f64;
            let mut next: HashMap<u64, Way> = HashMap::new();
            let mut least = f64::INFINITY;
            for (front, way) in &layers[placed] {
                let at_least = self.at_least(*front, way.cost, placed);
                least = least.min(at_least);
                if at_least >= best - 1e-12 {
                    continue;
                }
                for test in (0..count).filter(|test| front >> test & 1 == 0 && self.before[*test] & !front == 0) {
                    let cost = way.cost + self.tests.weights[test] * place;
                    let known = next.entry(front | 1 << test).or_insert(Way { cost, last: test });
                    // Of equally cheap ways the same one whatever the order of the map.
                    if (cost, test) < (known.cost, known.last) {
                        *known = Way { cost, last: test };
                    }
                }
            }
            sets += next.len();
            if sets > MAX_SETS {
                // Every order begins with some set of this size, or is no better than the best.
                return Err(least.min(best));
            }
            layers.push(next);
        }
        let mut front = if count == 64 { u64::MAX } else { (1 << count) - 1 };
        let mut order = Vec::with_capacity(count);
        for layer in layers[1..].iter().rev() {
            let Some(way) = layer.get(&front) else { return Ok(None) };
            order.push(way.last);
            front &= !(1 << way.last);
        }
        order.reverse();
        Ok(Some(order))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tests(weights: &[f64], before: &[(usize, usize)]) -> Tests {
        let mut list = vec![Vec::new(); weights.len()];
        before.iter().for_each(|(first, then)| list[*then].push(*first));
        Tests { weights: weights.to_vec(), before: list, passed: 0.0 }
    }

    #[test]
    fn the_heaviest_goes_first_unless_it_must_wait() {
        assert_eq!(tests(&[1.0, 3.0, 2.0], &[]).best(), (vec![1, 2, 0], 10.0));
        assert_eq!(tests(&[1.0, 3.0, 2.0], &[(0, 1)]).best(), (vec![0, 1, 2], 13.0));
        // Two light ones are worth going through for a heavy one, but not for a light one.
        assert_eq!(tests(&[0.0, 0.0, 9.0, 2.0], &[(0, 1), (1, 2)]).best().0, [0, 1, 2, 3]);
        assert_eq!(tests(&[0.0, 0.0, 1.0, 2.0], &[(0, 1), (1, 2)]).best().0, [3, 0, 1, 2]);
    }

    /// Every order of eight tests, for many weights and precedences.
    #[test]
    fn the_optimum_is_the_optimum() {
        let mut random = 1_u64;
        let mut next = |below: u64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) % below
        };
        for _ in 0..40 {
            let weights: Vec<f64> = (0..7).map(|_| next(10) as f64).collect();
            let mut before = Vec::new();
            for then in 1..7 {
                for first in 0..then {
                    if next(4) == 0 {
                        before.push((first, then));
                    }
                }
            }
            let tests = tests(&weights, &before);
            let mut cheapest = f64::INFINITY;
            let mut orders = vec![Vec::new()];
            while let Some(order) = orders.pop() {
                if order.len() == 7 {
                    cheapest = cheapest.min(tests.cost(&order));
                }
                for test in 0..7 {
                    if !order.contains(&test) && tests.before[test].iter().all(|first| order.contains(first)) {
                        orders.push([order.as_slice(), &[test]].concat());
                    }
                }
            }
            let (order, bound) = tests.best();
            assert_eq!((tests.cost(&order), bound), (cheapest, cheapest));
        }
    }
}
