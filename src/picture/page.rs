//! The frame of a page: one HTML file that needs no other and no network.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::diag::visible;

/// The style of every page; light or dark as the reader's system says.
const STYLE: &str = include_str!("page.css");

/// A whole page with this title and body. Figures keep a light ground in the dark.
pub fn page(title: &str, body: Markup) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { main { h1 { (title) } (body) } }
        }
    };
    visible(&markup.into_string()).into_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_stands_alone() {
        let text = page("a < b", html! { p { "x & y" } });
        assert!(text.starts_with("<!DOCTYPE html>") && text.contains("<title>a &lt; b</title>"), "{text}");
        assert!(text.contains("<p>x &amp; y</p>"), "{text}");
        assert!(!text.contains("http"), "nothing is loaded from elsewhere");
    }
}
