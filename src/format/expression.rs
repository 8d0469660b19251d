//! The spaces of an expression.
//!
//! Line breaks stay where they are. A space stands around every operator of
//! two operands, behind commas and inside the braces of an `if`, and nowhere
//! else. Coefficients are denser: a quotient of two numbers in a list is
//! written `1/6`.

use crate::table::lex::{Token, tokens};

/// The role of a pair of braces or brackets.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pair {
    /// `( )`, or `{ }` around levels or the fields of a record.
    Tight,
    /// `[ ]`
    List,
    /// `{ }` around a value.
    Block,
}

/// An expression with its spaces in order, its lines without those in front.
/// Each line comes with the blanks that it had in front.
pub(super) fn lines(text: &str) -> Option<Vec<(usize, String)>> {
    let tokens = tokens(text, 0).ok()?;
    let mut out = vec![(0, String::new())];
    let mut open: Vec<Pair> = Vec::new();
    let mut end = 0;
    for (index, (span, token)) in tokens.iter().enumerate() {
        let near = |offset: isize| index.checked_add_signed(offset).and_then(|i| tokens.get(i)).map(|(_, t)| t);
        let between = &text[end..span.start];
        // A number that runs into a word is of no expression: a pattern of bits with a letter in it.
        if let (Some(Token::Number(_)), Token::Word(_), "") = (near(-1), token, between) {
            return None;
        }
        let breaks = between.matches('\n').count();
        if breaks > 0 {
            let indent = between.rsplit('\n').next().map_or(0, |blanks| blanks.chars().count());
            // An empty line between two parts may stay, but no more than one.
            if breaks > 1 && index > 0 && *token != Token::End {
                out.push((0, String::new()));
            }
            if *token != Token::End {
                out.push((indent, String::new()));
            }
        }
        let inside = open.last().copied();
        if breaks == 0
            && index > 0
            && *token != Token::End
            && spaced(&tokens, index, inside)
            && let Some((_, line)) = out.last_mut()
        {
            line.push(' ');
        }
        match token {
            Token::Symbol("(") => open.push(Pair::Tight),
            Token::Symbol("[") => open.push(Pair::List),
            Token::Symbol("{") => {
                let levels = near(-1) == Some(&Token::Word("in"));
                let record = near(2) == Some(&Token::Symbol(":"));
                open.push(if levels || record { Pair::Tight } else { Pair::Block });
            }
            Token::Symbol(")" | "]" | "}") => {
                open.pop();
            }
            _ => {}
        }
        if let Some((_, line)) = out.last_mut() {
            line.push_str(&text[span.start..span.end]);
        }
        end = span.end;
    }
    Some(out)
}

/// Returns whether a space stands between a token and the one before, inside of a pair of brackets.
fn spaced(tokens: &[(crate::diag::Span, Token<'_>)], index: usize, inside: Option<Pair>) -> bool {
    let token = tokens[index].1;
    let before = tokens[index - 1].1;
    match (before, token) {
        (_, Token::Symbol("," | ";" | ":" | "::" | ")" | "]" | ".") | Token::End) => false,
        (Token::Symbol("(" | "[" | "!" | "~" | "." | "::"), _) => false,
        (Token::Symbol("{"), _) | (_, Token::Symbol("}")) => inside == Some(Pair::Block),
        (Token::Symbol("-"), _) => is_binary(tokens, index - 1),
        (Token::Word(word), Token::Symbol("(" | "[")) => is_keyword(word),
        (Token::Number(_), Token::Symbol("/")) => !is_fraction(tokens, index, inside),
        (Token::Symbol("/"), Token::Number(_)) => !is_fraction(tokens, index - 1, inside),
        _ => true,
    }
}

/// Returns whether the minus at an index stands between two operands.
fn is_binary(tokens: &[(crate::diag::Span, Token<'_>)], index: usize) -> bool {
    match index.checked_sub(1).map(|before| tokens[before].1) {
        Some(Token::Number(_) | Token::Symbol(")" | "]" | "}")) => true,
        Some(Token::Word(word)) => !is_keyword(word),
        _ => false,
    }
}

/// Returns whether the slash at an index stands between two numbers, as a coefficient of a list.
fn is_fraction(tokens: &[(crate::diag::Span, Token<'_>)], index: usize, inside: Option<Pair>) -> bool {
    let number = |at: Option<usize>| matches!(at.and_then(|at| tokens.get(at)), Some((_, Token::Number(_))));
    inside == Some(Pair::List) && number(index.checked_sub(1)) && number(index.checked_add(1))
}

fn is_keyword(word: &str) -> bool {
    matches!(word, "if" | "else" | "in" | "let")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(text: &str) -> String {
        let lines = lines(text).unwrap_or_default();
        lines.iter().map(|(_, line)| line.as_str()).collect::<Vec<_>>().join("|")
    }

    #[test]
    fn operators_have_spaces() {
        assert_eq!(one("1-px*-py"), "1 - px * -py");
        assert_eq!(one("  !( a||b )&&x<=- 1 "), "!(a || b) && x <= -1");
        assert_eq!(one("if V==top{py}else{1-py}"), "if V == top { py } else { 1 - py }");
        assert_eq!(
            one("if a { -x } else if b{c}else{ { r : 1 , s:2 } }"),
            "if a { -x } else if b { c } else { {r: 1, s: 2} }"
        );
        assert_eq!(one("H in { left,right }&&case(11 ,V=none)>0"), "H in {left, right} && case(11, V = none) > 0");
        assert_eq!(one("let n=1;  poly(x, [1, - 1 / 6, a/b])/2"), "let n = 1; poly(x, [1, -1/6, a / b]) / 2");
        assert_eq!(one("sin(s*x)/s|x=x0..x1"), "sin(s * x) / s | x = x0 .. x1");
        assert_eq!(one("sum( n in gauss,n.y*(a).x )- 1"), "sum(n in gauss, n.y * (a).x) - 1");
        assert_eq!(one("x in {-1,0}"), "x in {-1, 0}");
        assert_eq!(one("(w>>22)^~ w|0xFF"), "(w >> 22) ^ ~w | 0xFF");
        assert_eq!(one("[a :: b if c==k::-1]++ [d]"), "[a::b if c == k::-1] ++ [d]");
    }

    #[test]
    fn texts_that_are_no_expressions_stay() {
        assert_eq!(lines("0x"), None);
        assert_eq!(lines("1-01x"), None);
        assert_eq!(one("2 x"), "2 x");
    }

    #[test]
    fn lines_stay() {
        let expected = vec![(0, String::new()), (4, "let a = 1;".to_owned()), (6, "a + 2".to_owned())];
        assert_eq!(lines("\n    let a=1;\n      a+2"), Some(expected));
    }
}
