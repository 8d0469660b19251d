//! Parser of the expression language: precedence climbing over tokens.
//! The grammar is written down in `docs/language.md`.

use super::expr::{BinaryOp, Expr, ExprKind, SumOver, UnaryOp};
use super::lex::{self, Token};
use crate::diag::{Diagnostic, Span, Spanned, codes};

/// Deepest nesting of an expression. Every later stage, and naga in an
/// unoptimised build, recurses to the same depth.
pub const MAX_DEPTH: usize = 64;

/// Parses `text`, which starts at byte `base` of its source.
pub(crate) fn expression(text: &str, base: usize) -> Result<Expr, Diagnostic> {
    let tokens = lex::tokens(text, base)?;
    let mut parser = Parser { tokens, at: 0, depth: 0, bounds: false };
    if let Token::End = parser.peek() {
        return Err(Diagnostic::error(codes::EXPRESSION, "empty expression")
            .at(Span::new(base, base + text.len()), "expected a value or a condition"));
    }
    let expr = parser.block()?;
    match parser.peek() {
        Token::End => check_depth(&expr, 0).map(|()| expr),
        Token::Symbol(")") => {
            Err(parser.unexpected("an operator or the end of the expression").help("this `)` closes nothing"))
        }
        _ => Err(parser.unexpected("an operator or the end of the expression")),
    }
}

struct Parser<'a> {
    tokens: Vec<(Span, Token<'a>)>,
    at: usize,
    depth: usize,
    /// True if the bounds of `F | x = lo .. hi` are being read.
    bounds: bool,
}

/// The binary operator of a symbol, and its binding strength; comparisons do not chain.
fn strength(symbol: &str) -> Option<(u8, BinaryOp)> {
    BinaryOp::ALL.into_iter().find(|op| op.symbol() == symbol).map(|op| (op.strength(), op))
}

const COMPARISON: u8 = 3;
/// `F | x = lo .. hi` binds weaker than arithmetic and stronger than comparisons.
const SUM: u8 = 4;

impl<'a> Parser<'a> {
    fn peek(&self) -> Token<'a> {
        self.tokens[self.at].1
    }

    fn span(&self) -> Span {
        self.tokens[self.at].0
    }

    fn next(&mut self) -> (Span, Token<'a>) {
        let token = self.tokens[self.at];
        // The last token is `End`, which is never passed.
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        token
    }

    fn unexpected(&self, expected: &str) -> Diagnostic {
        Diagnostic::error(codes::EXPRESSION, format!("expected {expected}, found {}", self.peek().describe()))
            .at(self.span(), format!("expected {expected}"))
    }

    fn eat(&mut self, symbol: &'static str) -> bool {
        let found = self.peek() == Token::Symbol(symbol);
        if found {
            self.next();
        }
        found
    }

    fn expect(&mut self, symbol: &'static str) -> Result<Span, Diagnostic> {
        let span = self.span();
        if self.eat(symbol) { Ok(span) } else { Err(self.unexpected(&format!("`{symbol}`"))) }
    }

    /// Closes what `open` opened; the message shows both ends.
    fn close(&mut self, symbol: &'static str, open: Span) -> Result<Span, Diagnostic> {
        self.expect(symbol).map_err(|error| error.at(open, "opened here"))
    }

    fn keyword(&mut self, word: &str) -> bool {
        let found = self.peek() == Token::Word(word);
        if found {
            self.next();
        }
        found
    }

    fn name(&mut self, what: &str) -> Result<Spanned<String>, Diagnostic> {
        match self.peek() {
            Token::Word(word) => Ok(Spanned::new(self.next().0, word.to_owned())),
            _ => Err(self.unexpected(what)),
        }
    }

    /// Reads what stands in brackets for itself, even inside of bounds.
    fn bracketed<T>(&mut self, inner: impl FnOnce(&mut Self) -> Result<T, Diagnostic>) -> Result<T, Diagnostic> {
        let bounds = std::mem::replace(&mut self.bounds, false);
        let result = self.nested(inner);
        self.bounds = bounds;
        result
    }

    fn nested<T>(&mut self, inner: impl FnOnce(&mut Self) -> Result<T, Diagnostic>) -> Result<T, Diagnostic> {
        if self.depth == MAX_DEPTH {
            return Err(too_deep(self.span()));
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    /// `let name = expr; … expr`
    fn block(&mut self) -> Result<Expr, Diagnostic> {
        if self.peek() != Token::Word("let") {
            return self.nested(|p| p.binary(0));
        }
        let start = self.next().0;
        let name = self.name("a name for the value")?;
        self.expect("=")?;
        let value = self.nested(|p| p.binary(0))?;
        self.expect(";")?;
        let body = self.nested(Self::block)?;
        let span = start.to(body.span);
        Ok(Expr { span, kind: ExprKind::Let(name, Box::new(value), Box::new(body)) })
    }

    fn binary(&mut self, weakest: u8) -> Result<Expr, Diagnostic> {
        let mut left = self.unary()?;
        // A left-associative chain nests to the left: it counts as depth too.
        let mut links = 0;
        let mut compared = false;
        loop {
            let operator = match self.peek() {
                Token::Word("in") => None,
                Token::Symbol("|") if self.binds_next() => {
                    if weakest > SUM || self.bounds {
                        break;
                    }
                    links += 1;
                    if self.depth + links > MAX_DEPTH {
                        return Err(too_deep(self.span()));
                    }
                    left = self.between(left)?;
                    continue;
                }
                Token::Symbol(symbol) => match strength(symbol) {
                    Some(operator) if operator.0 >= weakest => Some(operator),
                    _ => break,
                },
                _ => break,
            };
            links += 1;
            if self.depth + links > MAX_DEPTH {
                return Err(too_deep(self.span()));
            }
            self.next();
            let Some((binds, op)) = operator else {
                left = self.membership(left)?;
                continue;
            };
            let right = self.nested(|p| p.binary(binds + 1))?;
            check_bits(op, &left, &right)?;
            if std::mem::replace(&mut compared, binds == COMPARISON) && compared {
                return Err(Diagnostic::error(codes::EXPRESSION, "comparisons cannot be chained")
                    .at(left.span.to(right.span), "write `a < b && b < c`"));
            }
            let span = left.span.to(right.span);
            left = Expr { span, kind: ExprKind::Binary(op, Box::new(left), Box::new(right)) };
        }
        Ok(left)
    }

    /// Returns whether a name and `=` follow the symbol that stands here, as in `F | x = lo .. hi`; behind the
    /// `|` of bits they never do.
    fn binds_next(&self) -> bool {
        let next = |beyond: usize| self.tokens.get(self.at + beyond).map(|(_, token)| *token);
        matches!((next(1), next(2)), (Some(Token::Word(_)), Some(Token::Symbol("="))))
    }

    /// `F | phi = lo .. hi`
    fn between(&mut self, body: Expr) -> Result<Expr, Diagnostic> {
        self.next();
        let variable = self.name("the variable to evaluate between bounds, as in `F | x = lo .. hi`")?;
        self.expect("=")?;
        // The bounds end at a further `|`: what stands before that is the whole of this.
        self.bounds = true;
        let bounds = self.bounds();
        self.bounds = false;
        let (lo, hi) = bounds?;
        let span = body.span.to(hi.span);
        Ok(Expr { span, kind: ExprKind::Between(Box::new(body), variable, Box::new(lo), Box::new(hi)) })
    }

    /// `lo .. hi`
    fn bounds(&mut self) -> Result<(Expr, Expr), Diagnostic> {
        let lo = self.nested(|p| p.binary(SUM))?;
        self.expect("..")?;
        Ok((lo, self.nested(|p| p.binary(SUM))?))
    }

    fn membership(&mut self, left: Expr) -> Result<Expr, Diagnostic> {
        let open = self.expect("{")?;
        let mut levels = Vec::new();
        loop {
            levels.push(self.level()?);
            if !self.eat(",") {
                break;
            }
        }
        let end = self.close("}", open)?;
        let span = left.span.to(end);
        Ok(Expr { span, kind: ExprKind::In(Box::new(left), levels) })
    }

    fn level(&mut self) -> Result<Spanned<String>, Diagnostic> {
        let negative = self.peek() == Token::Symbol("-");
        if negative {
            self.next();
        }
        match self.peek() {
            Token::Number(number) => {
                let span = self.next().0;
                Ok(Spanned::new(span, format!("{}", if negative { -number } else { number })))
            }
            _ if negative => Err(self.unexpected("a number")),
            _ => {
                let name = self.name("the name of a level")?;
                if self.peek() != Token::Symbol("::") {
                    return Ok(name);
                }
                let (set, level) = self.of_set(name)?;
                Ok(Spanned::new(set.span.to(level.span), format!("{}::{}", set.value, level.value)))
            }
        }
    }

    /// `set::level`, `table::set::level`, of which the first word is read: the set and the level.
    fn of_set(&mut self, first: Spanned<String>) -> Result<(Spanned<String>, Spanned<String>), Diagnostic> {
        let mut set = first;
        self.expect("::")?;
        loop {
            let negative = self.eat("-");
            let level = match self.peek() {
                Token::Number(number) => {
                    Spanned::new(self.next().0, format!("{}", if negative { -number } else { number }))
                }
                _ if negative => return Err(self.unexpected("a number")),
                _ => self.name("the name of a level")?,
            };
            if !self.eat("::") {
                return Ok((set, level));
            }
            set = Spanned::new(set.span.to(level.span), format!("{}::{}", set.value, level.value));
        }
    }

    fn unary(&mut self) -> Result<Expr, Diagnostic> {
        let op = match self.peek() {
            Token::Symbol("-") => UnaryOp::Negate,
            Token::Symbol("!") => UnaryOp::Not,
            Token::Symbol("~") => UnaryOp::BitNot,
            _ => return self.postfix(),
        };
        let start = self.next().0;
        let operand = self.nested(Self::unary)?;
        let span = start.to(operand.span);
        Ok(Expr { span, kind: ExprKind::Unary(op, Box::new(operand)) })
    }

    fn postfix(&mut self) -> Result<Expr, Diagnostic> {
        let mut expr = self.primary()?;
        let mut links = 0;
        while let Token::Symbol(symbol @ ("." | "[")) = self.peek() {
            links += 1;
            if self.depth + links > MAX_DEPTH {
                return Err(too_deep(self.span()));
            }
            let open = self.next().0;
            if symbol == "[" {
                let (indices, end) = self.arguments("]", open)?;
                if indices.is_empty() {
                    return Err(Diagnostic::error(codes::EXPRESSION, "an item of a list without an index")
                        .at(open.to(end), "expected an index, as in `curve[i]`"));
                }
                let span = expr.span.to(end);
                expr = Expr { span, kind: ExprKind::Index(Box::new(expr), indices) };
                continue;
            }
            let swizzle = self.name("a component such as `x` or `xy`")?;
            let span = expr.span.to(swizzle.span);
            expr = Expr { span, kind: ExprKind::Swizzle(Box::new(expr), swizzle) };
        }
        Ok(expr)
    }

    fn primary(&mut self) -> Result<Expr, Diagnostic> {
        let start = self.span();
        match self.peek() {
            Token::Number(number) => {
                self.next();
                Ok(Expr { span: start, kind: ExprKind::Number(number) })
            }
            Token::Symbol("(") => {
                self.next();
                let inner = self.bracketed(|p| p.binary(0))?;
                let end = self.close(")", start)?;
                Ok(Expr { span: start.to(end), ..inner })
            }
            Token::Symbol("{") => self.record(),
            Token::Symbol("[") => {
                self.next();
                let items = self.items(start)?;
                Ok(Expr { span: start.to(items.1), kind: ExprKind::List(items.0) })
            }
            Token::Word("if") => self.nested(Self::conditional),
            Token::Word("case") => self.case_reference(),
            Token::Word("let" | "else" | "in") => Err(self.unexpected("a value")),
            Token::Word(word) => {
                self.next();
                let open = self.span();
                if self.eat("(") {
                    if word == "sum" && matches!(self.tokens.get(self.at + 1), Some((_, Token::Word("in")))) {
                        return self.sum(start, open);
                    }
                    if word == "iterate" && self.binds_second() {
                        return self.iterate(start, open);
                    }
                    if matches!(self.peek(), Token::Word(_))
                        && matches!(self.tokens.get(self.at + 1), Some((_, Token::Symbol("="))))
                    {
                        return self.with(Spanned::new(start, word.to_owned()), open);
                    }
                    let (arguments, end) = self.arguments(")", open)?;
                    let callee = Spanned::new(start, word.to_owned());
                    return Ok(Expr { span: start.to(end), kind: ExprKind::Call(callee, arguments) });
                }
                if self.peek() == Token::Symbol("::") {
                    let (set, level) = self.of_set(Spanned::new(start, word.to_owned()))?;
                    return Ok(Expr { span: start.to(level.span), kind: ExprKind::Level(set, level) });
                }
                Ok(Expr { span: start, kind: ExprKind::Name(word.to_owned()) })
            }
            _ => Err(self.unexpected("a value")),
        }
    }

    /// `[a, b if c]`, behind the bracket.
    fn items(&mut self, open: Span) -> Result<(Vec<Expr>, Span), Diagnostic> {
        let mut items = Vec::new();
        let here = self.span();
        if self.eat("]") {
            return Ok((items, here));
        }
        loop {
            let item = self.bracketed(|p| p.binary(0))?;
            items.push(match self.keyword("if") {
                true => {
                    let condition = self.bracketed(|p| p.binary(0))?;
                    let span = item.span.to(condition.span);
                    Expr { span, kind: ExprKind::Optional(Box::new(item), Box::new(condition)) }
                }
                false => item,
            });
            if !self.eat(",") {
                break;
            }
        }
        let end = self.close("]", open)?;
        Ok((items, end))
    }

    fn arguments(&mut self, end: &'static str, open: Span) -> Result<(Vec<Expr>, Span), Diagnostic> {
        let mut arguments = Vec::new();
        let here = self.span();
        if self.eat(end) {
            return Ok((arguments, here));
        }
        loop {
            arguments.push(self.bracketed(|p| p.binary(0))?);
            if !self.eat(",") {
                break;
            }
        }
        let end = self.close(end, open)?;
        Ok((arguments, end))
    }

    /// `f(p = a, q = b)`
    fn with(&mut self, callee: Spanned<String>, open: Span) -> Result<Expr, Diagnostic> {
        let mut set = Vec::new();
        loop {
            let parameter = self.name("the parameter to set")?;
            self.expect("=")?;
            set.push((parameter, self.bracketed(|p| p.binary(0))?));
            if !self.eat(",") {
                break;
            }
        }
        let end = self.close(")", open)?;
        Ok(Expr { span: callee.span.to(end), kind: ExprKind::With(callee, set) })
    }

    /// `sum(n in nodes, term)`, `sum(i in 1 .. 4, term)`
    fn sum(&mut self, start: Span, open: Span) -> Result<Expr, Diagnostic> {
        let variable = self.name("the name of the item")?;
        self.next();
        let over = match (self.peek(), self.tokens.get(self.at + 1)) {
            (Token::Word(list), Some((_, Token::Symbol(",")))) => {
                SumOver::Items(Spanned::new(self.next().0, list.to_owned()))
            }
            _ => {
                let (lo, hi) = self.bounds()?;
                SumOver::Range(Box::new(lo), Box::new(hi))
            }
        };
        self.expect(",")?;
        let term = self.bracketed(|p| p.binary(0))?;
        let end = self.close(")", open)?;
        Ok(Expr { span: start.to(end), kind: ExprKind::Sum(variable, over, Box::new(term)) })
    }

    /// Returns whether the second of the arguments that stand here begins with `name =`.
    fn binds_second(&self) -> bool {
        let mut open = 0_usize;
        for (at, (_, token)) in self.tokens.iter().enumerate().skip(self.at) {
            match token {
                Token::Symbol("(" | "[" | "{") => open += 1,
                Token::Symbol(")" | "]" | "}") if open == 0 => return false,
                Token::Symbol(")" | "]" | "}") => open -= 1,
                Token::Symbol(",") if open == 0 => {
                    let next = |beyond: usize| self.tokens.get(at + beyond).map(|(_, token)| *token);
                    return matches!((next(1), next(2)), (Some(Token::Word(_)), Some(Token::Symbol("="))));
                }
                Token::Symbol(_) | Token::Number(_) | Token::Word(_) | Token::End => {}
            }
        }
        false
    }

    /// `iterate(3, x = 1, 0.5 * (x + a / x))`
    fn iterate(&mut self, start: Span, open: Span) -> Result<Expr, Diagnostic> {
        let count = self.bracketed(|p| p.binary(0))?;
        self.expect(",")?;
        let variable = self.name("the name of the value")?;
        self.expect("=")?;
        let first = self.bracketed(|p| p.binary(0))?;
        self.expect(",")?;
        let step = self.bracketed(|p| p.binary(0))?;
        let end = self.close(")", open)?;
        let kind = ExprKind::Iterate(Box::new(count), variable, Box::new(first), Box::new(step));
        Ok(Expr { span: start.to(end), kind })
    }

    /// `{x: a, y: b}`
    fn record(&mut self) -> Result<Expr, Diagnostic> {
        let open = self.next().0;
        let mut fields = Vec::new();
        loop {
            let name = self.name("the name of a number, as in `{x: 1, y: 2}`")?;
            self.expect(":")?;
            fields.push((name, self.bracketed(|p| p.binary(0))?));
            if !self.eat(",") {
                break;
            }
        }
        let end = self.close("}", open)?;
        Ok(Expr { span: open.to(end), kind: ExprKind::Record(fields) })
    }

    fn conditional(&mut self) -> Result<Expr, Diagnostic> {
        let start = self.next().0;
        let condition = self.nested(|p| p.binary(0))?;
        let (then, _) = self.braced()?;
        if !self.keyword("else") {
            return Err(self.unexpected("`else`").help("every `if` has a value, so every `if` needs an `else`"));
        }
        let (other, end) = if self.peek() == Token::Word("if") {
            let other = self.nested(Self::conditional)?;
            let end = other.span;
            (other, end)
        } else {
            self.braced()?
        };
        let kind = ExprKind::If(Box::new(condition), Box::new(then), Box::new(other));
        Ok(Expr { span: start.to(end), kind })
    }

    fn braced(&mut self) -> Result<(Expr, Span), Diagnostic> {
        let open = self.expect("{")?;
        let body = self.bracketed(Self::block)?;
        let end = self.close("}", open)?;
        Ok((body, end))
    }

    /// `case(11, V = none)`
    fn case_reference(&mut self) -> Result<Expr, Diagnostic> {
        let start = self.next().0;
        let open = self.expect("(")?;
        let id = match self.peek() {
            Token::Number(n) if n.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&n) => {
                Spanned::new(self.next().0, n as u32)
            }
            _ => return Err(self.unexpected("the number of a case")),
        };
        let mut set = Vec::new();
        while self.eat(",") {
            let input = self.name("the input to replace")?;
            self.expect("=")?;
            set.push((input, self.nested(|p| p.binary(0))?));
        }
        let end = self.close(")", open)?;
        Ok(Expr { span: start.to(end), kind: ExprKind::Case(id, set) })
    }
}

/// Refuses an operation on bits beside another operator, unless one of them stands in parentheses, or both are the
/// same `&`, `|` or `^`. Comparisons and logic are weaker than either, and may stand there.
fn check_bits(op: BinaryOp, left: &Expr, right: &Expr) -> Result<(), Diagnostic> {
    for side in [left, right] {
        // What stands in parentheses begins before its first operand.
        let ExprKind::Binary(inner, first, _) = &side.kind else { continue };
        let is_chain = op == *inner && matches!(op, BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor);
        let mixes = op.strength() > COMPARISON && (op.is_on_bits() || inner.is_on_bits());
        if side.span.start == first.span.start && mixes && !is_chain {
            let message = format!("`{}` and `{}` beside each other", inner.symbol(), op.symbol());
            return Err(Diagnostic::error(codes::EXPRESSION, message)
                .at(side.span, "put this into parentheses, or what is meant to go together"));
        }
    }
    Ok(())
}

/// Chains inside parentheses inside chains: each is short, but the tree may still be deep.
fn check_depth(expr: &Expr, depth: usize) -> Result<(), Diagnostic> {
    if depth > MAX_DEPTH {
        return Err(too_deep(expr.span));
    }
    let below = |expr: &Expr| check_depth(expr, depth + 1);
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Level(..) => Ok(()),
        ExprKind::Unary(_, a) | ExprKind::In(a, _) | ExprKind::Swizzle(a, _) => below(a),
        ExprKind::Binary(_, a, b) | ExprKind::Let(_, a, b) | ExprKind::Optional(a, b) => {
            below(a).and_then(|()| below(b))
        }
        ExprKind::If(a, b, c) => below(a).and_then(|()| below(b)).and_then(|()| below(c)),
        ExprKind::Call(_, items) | ExprKind::List(items) => items.iter().try_for_each(below),
        ExprKind::Case(_, set) | ExprKind::With(_, set) | ExprKind::Record(set) => {
            set.iter().try_for_each(|(_, value)| below(value))
        }
        ExprKind::Between(body, _, lo, hi) => below(body).and_then(|()| below(lo)).and_then(|()| below(hi)),
        ExprKind::Sum(_, over, term) => {
            if let SumOver::Range(lo, hi) = over {
                below(lo).and_then(|()| below(hi))?;
            }
            below(term)
        }
        ExprKind::Iterate(count, _, start, step) => below(count).and_then(|()| below(start)).and_then(|()| below(step)),
        ExprKind::Index(list, indices) => below(list).and_then(|()| indices.iter().try_for_each(below)),
    }
}

fn too_deep(span: Span) -> Diagnostic {
    Diagnostic::error(codes::TOO_DEEP, format!("the expression is nested deeper than {MAX_DEPTH} levels"))
        .at(span, "too deep from here on")
        .help("give parts of it a name under `names` and use the names")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tree, fully parenthesised.
    fn shape(expr: &Expr) -> String {
        match &expr.kind {
            ExprKind::Number(n) => format!("{n}"),
            ExprKind::Name(n) => n.clone(),
            ExprKind::Level(set, level) => format!("<{} of {}>", level.value, set.value),
            ExprKind::Optional(a, c) => format!("{} if {}", shape(a), shape(c)),
            ExprKind::Unary(op, a) => format!("({}{})", op.symbol(), shape(a)),
            ExprKind::Binary(op, a, b) => format!("({} {} {})", shape(a), op.symbol(), shape(b)),
            ExprKind::In(a, levels) => {
                format!("({} in {})", shape(a), levels.iter().map(|l| l.value.as_str()).collect::<Vec<_>>().join("|"))
            }
            ExprKind::Call(f, args) => {
                format!("{}({})", f.value, args.iter().map(shape).collect::<Vec<_>>().join(", "))
            }
            ExprKind::Swizzle(a, s) => format!("{}.{}", shape(a), s.value),
            ExprKind::Case(id, set) => {
                let set: String = set.iter().map(|(n, e)| format!(", {} = {}", n.value, shape(e))).collect();
                format!("case({}{set})", id.value)
            }
            ExprKind::If(c, a, b) => format!("if {} {{{}}} else {{{}}}", shape(c), shape(a), shape(b)),
            ExprKind::Let(n, a, b) => format!("let {} = {}; {}", n.value, shape(a), shape(b)),
            ExprKind::List(items) => format!("[{}]", items.iter().map(shape).collect::<Vec<_>>().join(", ")),
            ExprKind::With(f, set) => format!("{}({})", f.value, fields(set, " = ")),
            ExprKind::Between(body, x, lo, hi) => {
                format!("({} | {} = {} .. {})", shape(body), x.value, shape(lo), shape(hi))
            }
            ExprKind::Sum(x, SumOver::Items(list), term) => {
                format!("sum({} in {}, {})", x.value, list.value, shape(term))
            }
            ExprKind::Sum(x, SumOver::Range(lo, hi), term) => {
                format!("sum({} in {} .. {}, {})", x.value, shape(lo), shape(hi), shape(term))
            }
            ExprKind::Record(set) => format!("{{{}}}", fields(set, ": ")),
            ExprKind::Iterate(n, x, start, step) => {
                format!("iterate({}, {} = {}, {})", shape(n), x.value, shape(start), shape(step))
            }
            ExprKind::Index(list, indices) => {
                format!("{}[{}]", shape(list), indices.iter().map(shape).collect::<Vec<_>>().join(", "))
            }
        }
    }

    fn fields(set: &[(Spanned<String>, Expr)], symbol: &str) -> String {
        set.iter().map(|(n, e)| format!("{}{symbol}{}", n.value, shape(e))).collect::<Vec<_>>().join(", ")
    }

    fn parsed(text: &str) -> String {
        expression(text, 0).map(|e| shape(&e)).unwrap_or_else(|d| format!("error: {}", d.message))
    }

    #[test]
    fn precedence_follows_wgsl() {
        assert_eq!(parsed("a + b * c - d"), "((a + (b * c)) - d)");
        assert_eq!(parsed("a || b && !c == d"), "(a || (b && ((!c) == d)))");
        assert_eq!(parsed("1 - py < dH"), "((1 - py) < dH)");
        assert_eq!(parsed("H in {left, right} && x"), "((H in left|right) && x)");
        assert_eq!(parsed("(a + b).x"), "(a + b).x");
        assert_eq!(parsed("(a < b) == c"), "((a < b) == c)");
    }

    #[test]
    fn structured_forms() {
        assert_eq!(
            parsed("if H == left { case(11, V = none) } else if x { 1 } else { let q = 2; q }"),
            "if (H == left) {case(11, V = none)} else {if x {1} else {let q = 2; q}}"
        );
        assert_eq!(parsed("[a, b]"), "[a, b]");
        assert_eq!(
            parsed("[a, b + 1 if c && d, if e { a } else { b } if f]"),
            "[a, (b + 1) if (c && d), if e {a} else {b} if f]"
        );
        assert_eq!(parsed("[a] ++ b ++ [c]"), "(([a] ++ b) ++ [c])");
        assert_eq!(parsed("e == edge::left"), "(e == <left of edge>)");
        assert_eq!(parsed("f(t::k::-1, {a:k::b})"), "f(<-1 of t::k>, {a: <b of k>})");
        assert_eq!(parsed("e in {k::a, b}"), "(e in k::a|b)");
        assert_eq!(parsed("f(p = a, q = b + 1)"), "f(p = a, q = (b + 1))");
        assert_eq!(parsed("sum(n in nodes, n.x * f(n.y))"), "sum(n in nodes, (n.x * f(n.y)))");
        assert_eq!(parsed("sum(i in 0..3, i)"), "sum(i in 0 .. 3, i)");
        assert_eq!(parsed("iterate(f(1, 2), x = a, x + b)"), "iterate(f(1, 2), x = a, (x + b))");
        assert_eq!(parsed("iterate(1, 2) + iterate(f(y = 1), 2)"), "(iterate(1, 2) + iterate(f(y = 1), 2))");
        assert_eq!(parsed("m[i][j + 1].x * m[i, j]"), "(m[i][(j + 1)].x * m[i, j])");
        assert_eq!(parsed("let q = 1; {x: a + q, y: -b}"), "let q = 1; {x: (a + q), y: (-b)}");
    }

    #[test]
    fn between_bounds_is_weaker_than_arithmetic() {
        assert_eq!(parsed("a + sin(x) / s | x = lo .. hi"), "((a + (sin(x) / s)) | x = lo .. hi)");
        assert_eq!(parsed("(F | x = lo..hi) / 2 < b"), "(((F | x = lo .. hi) / 2) < b)");
        assert_eq!(parsed("b < F | x = lo .. h + 1"), "(b < (F | x = lo .. (h + 1)))");
        assert_eq!(parsed("F | x = 0 .. 1 | y = 0..2.5"), "((F | x = 0 .. 1) | y = 0 .. 2.5)");
        assert_eq!(parsed("F | x = 0 1"), "error: expected `..`, found a number");
        assert_eq!(parsed("F | x 0"), "error: expected an operator or the end of the expression, found a number");
    }

    #[test]
    fn operations_on_bits_stand_by_themselves() {
        assert_eq!(parsed("(w >> 22) ^ w"), "((w >> 22) ^ w)");
        assert_eq!(parsed("a & ~b & 0xFf"), "((a & (~b)) & 255)");
        assert_eq!(parsed("(a | b) == c | d && e"), "(((a | b) == (c | d)) && e)");
        assert_eq!(parsed("a | b | x = 0 .. 1 | 2"), "((a | b) | x = 0 .. (1 | 2))");
        assert_eq!(parsed("s >> ((s >> 28) + 4)"), "(s >> ((s >> 28) + 4))");
        assert_eq!(parsed("a + b << c"), "error: `<<` and `+` beside each other");
        assert_eq!(parsed("a << b - c"), "error: `<<` and `-` beside each other");
        assert_eq!(parsed("a & b | c"), "error: `&` and `|` beside each other");
        assert_eq!(parsed("a << b << c"), "error: `<<` and `<<` beside each other");
        assert_eq!(parsed("0x100000000"), "error: `0x100000000` is not a usable number");
        assert_eq!(parsed("0x"), "error: `0x` is not a usable number");
    }

    #[test]
    fn mistakes_are_named() {
        assert_eq!(parsed("(a + b"), "error: expected `)`, found the end of the expression");
        assert_eq!(parsed("a + b)"), "error: expected an operator or the end of the expression, found `)`");
        assert_eq!(parsed("a < b < c"), "error: comparisons cannot be chained");
        assert_eq!(parsed("(a) == b == (c)"), "error: comparisons cannot be chained");
        assert_eq!(parsed("a in {-b}"), "error: expected a number, found `b`");
        assert_eq!(parsed("if a { 1 }"), "error: expected `else`, found the end of the expression");
        assert_eq!(parsed(""), "error: empty expression");
        assert_eq!(parsed("k::"), "error: expected the name of a level, found the end of the expression");
        assert_eq!(parsed("f(a if b)"), "error: expected `)`, found `if`");
        assert_eq!(parsed("a $ b"), "error: `$` has no meaning here");
        assert_eq!(parsed("1e999"), "error: `1e999` is not a usable number");
    }

    #[test]
    fn depth_is_bounded() {
        let stairs = (1..=60).fold("(".repeat(60) + "a", |text, links| text + ")" + &"+a".repeat(links));
        for text in [
            "(".repeat(10_000),
            "-".repeat(10_000),
            "1+".repeat(10_000) + "1",
            "if a {".repeat(10_000),
            "a".to_owned() + &" in {b}".repeat(10_000),
            "a".to_owned() + &" .x".repeat(10_000),
            "a".to_owned() + &" | x = a .. b".repeat(10_000),
            "{x:".repeat(10_000),
            "sum(x in a, ".repeat(10_000),
            "iterate(1, x = 1, ".repeat(10_000),
            "a".to_owned() + &"[b]".repeat(10_000),
            "a[".repeat(10_000),
            stairs,
        ] {
            assert!(parsed(&text).contains("nested deeper"), "{}", parsed(&text));
        }
    }
}
