//! What a table declares beside its cases: symmetries, assumptions, pictures, continuity.

use super::expression::{OR, Piece, Scope, Type, Visible};
use super::inputs::Kind;
use super::{Maker, map};

/// An item that begins with a square bracket, closed by one.
fn nested(item: String) -> String {
    format!("{}]", item.strip_suffix(')').unwrap_or(&item))
}

impl Maker<'_, '_> {
    /// Inputs of one kind, by their places.
    fn alike(&self, kind: Kind) -> Vec<usize> {
        (0..self.inputs.len()).filter(|place| self.inputs[*place].kind == kind).collect()
    }

    /// Symmetries: names and what they do.
    pub(super) fn symmetries(&mut self) -> Vec<(String, String)> {
        let mut written = Vec::new();
        for _ in 0..self.choices.within(1, 3) {
            let images = self.images();
            if images.is_empty() {
                continue;
            }
            let mut text = format!("Symmetry(map: {}", map(&images));
            if self.one_number && self.choices.one_in(3) {
                let result = *self.choices.pick(&["1 - value", "-value", "value", "0.5 - value"]);
                text += &format!(", result: \"{result}\"");
            }
            if self.choices.one_in(3) {
                text += &format!(", doc: {}", self.doc());
            }
            let name = self.plain_name("turn");
            written.push((name, text + ")"));
        }
        written
    }

    /// What some inputs are replaced by; each image undoes itself.
    fn images(&mut self) -> Vec<(String, String)> {
        let mut images: Vec<(String, String)> = Vec::new();
        for place in 0..self.inputs.len() {
            let name = self.inputs[place].name.clone();
            if images.iter().any(|(mapped, _)| *mapped == name) || !self.choices.either() {
                continue;
            }
            let kind = self.inputs[place].kind;
            let other = self.alike(kind).into_iter().find(|other| {
                *other > place
                    && !matches!(kind, Kind::Wide(_))
                    && self.inputs[*other].fetched == self.inputs[place].fetched
                    && images.iter().all(|(mapped, _)| *mapped != self.inputs[*other].name)
            });
            if let (Some(other), true) = (other, self.choices.either()) {
                let there = self.inputs[other].name.clone();
                self.exchange(&mut images, kind, &name, &there);
                continue;
            }
            let image = match kind {
                Kind::Bool => format!("\"!{name}\""),
                Kind::Wide(_) => continue,
                Kind::Levels(set) if self.sets[set].integers => continue,
                Kind::Levels(set) => {
                    let levels = self.sets[set].levels.clone();
                    let [a, b] = [levels.first(), levels.last()].map(|level| level.cloned().unwrap_or_default());
                    map(&[(a.clone(), b.clone()), (b, a)])
                        .replace(": ", ": \"")
                        .replace(", ", "\", ")
                        .replace('}', "\"}")
                }
                Kind::Range(lo, hi) => match lo.parse::<f64>().unwrap_or(0.0) + hi.parse::<f64>().unwrap_or(0.0) {
                    0.0 => format!("\"-{name}\""),
                    sum => format!("\"{sum} - {name}\""),
                },
            };
            images.push((name, image));
        }
        images
    }

    /// Two inputs exchanged, as expressions or level by level.
    fn exchange(&mut self, images: &mut Vec<(String, String)>, kind: Kind, here: &str, there: &str) {
        let written = |from: &str| match kind {
            Kind::Levels(_) => format!("From(\"{from}\", {{}})"),
            Kind::Bool | Kind::Range(..) | Kind::Wide(_) => format!("\"{from}\""),
        };
        let by_levels = matches!(kind, Kind::Levels(set) if !self.sets[set].integers) && self.choices.either();
        let image = |from: &str| if by_levels { written(from) } else { format!("\"{from}\"") };
        images.push((here.to_owned(), image(there)));
        images.push((there.to_owned(), image(here)));
    }

    /// Conditions that hold wherever the table is used.
    pub(super) fn assumptions(&mut self) -> String {
        let mut written = Vec::new();
        for _ in 0..self.choices.within(1, 2) {
            let scope = self.scope.clone();
            let condition = self.guard(&scope, 1);
            let name = self.plain_name("sure");
            let reason = if self.choices.either() { format!("({condition}, {})", self.doc()) } else { condition };
            written.push((name, reason));
        }
        map(&written)
    }

    /// Drawing hints.
    pub(super) fn drawing(&mut self) -> String {
        let mut written: Vec<(String, String)> = Vec::new();
        let mut sided: Option<String> = None;
        let mut run: Option<String> = None;
        for place in 0..self.inputs.len() {
            if self.choices.one_in(3) {
                continue;
            }
            let (name, kind) = (self.inputs[place].name.clone(), self.inputs[place].kind);
            let hint = match kind {
                Kind::Wide(_) => continue,
                Kind::Range(..) => match (&run, self.choices.below(3)) {
                    // Runs are rare, so one that is there is used.
                    (Some(run), 0 | 2) => format!("Position(\"{run}\")"),
                    (_, 1) => "Down".to_owned(),
                    _ => "Across".to_owned(),
                },
                Kind::Bool => match &sided {
                    Some(sided) => format!("Strong(\"{sided}\")"),
                    None => "Dark([true])".to_owned(),
                },
                Kind::Levels(set) => {
                    let level = self.sets[set].levels[0].clone();
                    match (sided.clone(), self.choices.below(4)) {
                        (None, 0 | 1) => format!("Dark([\"{level}\"])"),
                        (Some(sided), 0 | 1) => {
                            run = Some(name.clone());
                            format!("Run(along: \"{sided}\", ends: {{\"{level}\": {}}})", self.choices.below(3))
                        }
                        (_, 2) => format!("Sides(of: left, levels: {{\"{level}\": [right]}})"),
                        _ => {
                            sided = Some(name.clone());
                            format!("Sides(levels: {{\"{level}\": [left, top]}})")
                        }
                    }
                }
            };
            written.push((name, hint));
        }
        if written.is_empty() { String::new() } else { map(&written) }
    }

    /// Places where the value is meant not to jump.
    pub(super) fn continuity(&mut self) -> String {
        let numbers: Vec<(String, Kind)> = self
            .inputs
            .iter()
            .filter(|input| matches!(input.kind, Kind::Range(..)))
            .map(|input| (input.name.clone(), input.kind))
            .collect();
        let Some((name, Kind::Range(lo, hi))) = numbers.first().cloned() else { return String::new() };
        let mut written = Vec::new();
        if self.choices.either() {
            let all: Vec<String> = numbers.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            written.push((self.plain_name("cut"), format!("Switch(of: [{}])", self.choices.some(&all).join(", "))));
        }
        if self.choices.either() || written.is_empty() {
            let free: Vec<String> = self
                .inputs
                .iter()
                .filter(|input| input.name != name)
                .map(|input| format!("\"{}\"", input.name))
                .collect();
            let free = match free.is_empty() || self.choices.either() {
                true => String::new(),
                false => format!(", free: [{}]", self.choices.some(&free).join(", ")),
            };
            let border = format!("Border(when: \"{name} == {hi}\", map: {{\"{name}\": \"{lo}\"}}{free})");
            written.push((self.plain_name("wrap"), border));
        }
        map(&written)
    }

    /// Constant data: numbers, and lists of numbers or of several numbers each.
    pub(super) fn constants(&mut self) -> String {
        let mut written = Vec::new();
        for _ in 0..self.choices.within(1, 3) {
            let name = self.plain_name("k");
            match self.choices.below(3) {
                0 => {
                    let scope = self.scope.constants();
                    let value = self.expression(&scope, &Type::Number, 0);
                    written.push((name.clone(), self.in_quotes(value.text)));
                    self.scope.add(Visible { text: name, ty: Type::Number, input: false });
                }
                form => {
                    let width = if form == 1 { 1 } else { self.choices.within(2, 4) };
                    let count = self.choices.within(1, 4);
                    let item = |maker: &mut Self| {
                        let number = maker.literal();
                        if maker.choices.one_in(3) { format!("\"-sqrt({number})\"") } else { format!("\"{number}\"") }
                    };
                    let items = (0..count).map(|_| match width {
                        1 => item(self),
                        _ => format!("({})", (0..width).map(|_| item(self)).collect::<Vec<_>>().join(", ")),
                    });
                    let items: Vec<String> = items.collect();
                    // Two to four numbers are written in one way or the other.
                    let items: Vec<String> = match width > 1 && self.choices.one_in(4) {
                        true => {
                            self.later = true;
                            items.iter().map(|item| item.replacen('(', "[", 1)).map(nested).collect()
                        }
                        false => items,
                    };
                    written.push((name.clone(), format!("[{}]", items.join(", "))));
                    self.scope.lists.push((name, width, count));
                }
            }
        }
        map(&written)
    }

    /// Claims about what is constant, and about numbers of some inputs; most of them hold.
    pub(super) fn claimed(&mut self) -> String {
        let mut written = Vec::new();
        for _ in 0..self.choices.within(1, 3) {
            let name = self.plain_name("c");
            let number = self.inputs.iter().find(|input| !input.fetched && matches!(input.kind, Kind::Range(..)));
            let number = number.map(|input| input.name.clone());
            let constants = self.scope.constants();
            let made = self.expression(&constants, &Type::Number, 1);
            let [held, again] = [made.clone(), made].map(|piece| self.held(piece, super::expression::PRIMARY, false));
            let claim = match (number, self.choices.below(3)) {
                (Some(x), 0) => format!(
                    "Equal(left: \"({x} + 1) * ({x} - {held})\", right: \"{x} * {x} + {x} - {again} * ({x} + 1)\", for: [\"{x}\"])"
                ),
                (Some(x), 1) => format!(
                    "Within(left: \"sin({x} + {held})\", right: \"0\", by: \"1\", for: [\"{x}\"], doc: {})",
                    self.doc()
                ),
                _ => format!("Equal(left: \"{held}\", right: \"{again}\", tolerance: 0)"),
            };
            written.push((name, claim));
        }
        map(&written)
    }

    /// Functions for use inside of the table.
    pub(super) fn helpers(&mut self, depth: usize) -> String {
        let mut written = Vec::new();
        for _ in 0..self.choices.within(1, 3) {
            let name = self.plain_name("h");
            let mut scope = Scope { cases: Vec::new(), ..self.scope.clone() };
            // A helper sees its parameters and the constants.
            scope.visible.retain(|visible| visible.ty == Type::Number && visible.text.starts_with("k_"));
            scope.callable.retain(|callable| callable.name.starts_with("h_"));
            let mut parameters = Vec::new();
            for _ in 0..self.choices.within(1, 3) {
                let ty = match self.choices.below(8) {
                    0..=4 => Type::Number,
                    5 => Type::Vector(self.choices.within(2, 4)),
                    6 => Type::Condition,
                    _ => Type::numbers(&["area", "ss"]),
                };
                parameters.push((self.plain_name("p"), ty));
            }
            for (text, ty) in &parameters {
                scope.add(Visible { text: text.clone(), ty: ty.clone(), input: false });
            }
            let gives = match self.choices.below(5) {
                0..=2 => Type::Number,
                3 => Type::Vector(self.choices.within(2, 4)),
                _ => Type::numbers(&["area", "ss"]),
            };
            let value = match self.choices.one_in(3) {
                true => {
                    let first = self.quoted(&scope, &gives, depth);
                    let condition = self.text_without_inputs(&scope);
                    let last = self.quoted(&scope, &gives, depth);
                    format!("[({first}, \"{condition}\"), {last}]")
                }
                false => self.quoted(&scope, &gives, depth),
            };
            let list: Vec<&str> = parameters.iter().map(|(name, _)| name.as_str()).collect();
            written.push((format!("{name}({})", list.join(", ")), value));
            self.scope.callable.push(super::expression::Callable { name, parameters, gives, by_name: false });
        }
        map(&written)
    }

    /// A condition of what a helper sees, which may be nothing but numbers.
    fn text_without_inputs(&mut self, scope: &Scope) -> String {
        let made = self.expression(scope, &Type::Condition, 1);
        let Piece { text, .. } = if made.strength == 0 { Piece::new(OR, "1 < 2") } else { made };
        text
    }
}
