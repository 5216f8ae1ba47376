//! Pieces of a page. Text from the case is escaped here and nowhere else: what is made of it is [`Html`], and only that goes into a page.

use crate::error::plain_lines;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::fmt::Write;

/// Text that is HTML already; it is well-formed XML too.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Html(String);

impl Html {
    /// A text as it is to be read, with nothing in it that a reader would take for markup.
    pub fn text(text: &str) -> Self {
        let mut escaped = String::with_capacity(text.len() + 16);
        for c in plain_lines(text).chars() {
            match c {
                '&' => escaped.push_str("&amp;"),
                '<' => escaped.push_str("&lt;"),
                '>' => escaped.push_str("&gt;"),
                '"' => escaped.push_str("&quot;"),
                '\'' => escaped.push_str("&#39;"),
                // What XML cannot have at all.
                '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
                c => escaped.push(c),
            }
        }
        Self(escaped)
    }

    /// An element around something.
    pub fn element(name: &'static str, inner: Self) -> Self {
        Self(format!("<{name}>{}</{name}>\n", inner.0))
    }

    /// An element around a text.
    pub fn of(name: &'static str, text: &str) -> Self {
        Self::element(name, Self::text(text))
    }

    /// A picture drawn by the program as SVG, which has escaped its text.
    pub fn figure(svg: String, caption: &str) -> Self {
        let caption = if caption.is_empty() { Self::default() } else { Self::of("figcaption", caption) };
        Self(format!("<figure tabindex=\"0\">{svg}{}</figure>\n", caption.0))
    }

    /// A picture as PNG, within the page.
    pub fn image(png: &[u8], width: u32, caption: &str) -> Self {
        let (data, caption) = (BASE64_STANDARD.encode(png), Self::text(caption).0);
        Self(format!(
            "<figure tabindex=\"0\"><img width=\"{width}\" alt=\"{caption}\" src=\"data:image/png;base64,{data}\"/><figcaption>{caption}</figcaption></figure>\n"
        ))
    }

    /// A table with a row of headings.
    pub fn table(headings: &[String], rows: &[Vec<String>]) -> Self {
        let cells = |name: &str, row: &[String]| {
            row.iter().fold(String::new(), |mut text, cell| {
                let _ = write!(text, "<{name}>{}</{name}>", Self::text(cell).0);
                text
            })
        };
        let mut text = format!("<table><thead><tr>{}</tr></thead><tbody>\n", cells("th", headings));
        for row in rows {
            let _ = writeln!(text, "<tr>{}</tr>", cells("td", row));
        }
        text.push_str("</tbody></table>\n");
        Self(text)
    }

    /// Items below each other.
    pub fn list(items: &[String]) -> Self {
        let items = items.iter().map(|item| Self::of("li", item)).fold(Self::default(), Self::and);
        Self::element("ul", items)
    }

    /// This and what follows.
    #[must_use]
    pub fn and(mut self, next: Self) -> Self {
        self.0.push_str(&next.0);
        self
    }

    /// The page, with nothing that is loaded from elsewhere; its policy has readers refuse what is.
    pub fn page(title: &str, body: &Self) -> String {
        // One after the other: what a text has in it that looks like a mark is none.
        let (begin, rest) = PAGE.split_once("TITLE").unwrap_or((PAGE, ""));
        let (middle, end) = rest.split_once("BODY").unwrap_or((rest, ""));
        [begin, &Self::text(title).0, middle, &body.0, end].concat()
    }
}

/// A page, with how it looks on a screen and on paper; the marks `TITLE` and `BODY` stand for what is in it.
const PAGE: &str = include_str!("page.html");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stays_text() {
        let hostile = "</title><script>alert(\"1\")</script> ' & \u{1} \u{ffff}";
        let page = Html::page(hostile, &Html::of("p", hostile).and(Html::image(&[1, 2, 3], 10, hostile)));
        assert!(page.ends_with("</figure>\n</body>\n</html>\n") && page.contains("<style>\nbody {"), "{page}");
        assert!(!page.contains("<script") && page.contains("&lt;script&gt;alert(&quot;1&quot;)"), "{page}");
        assert!(!page.chars().any(|c| c == '\u{1}' || c == '\u{ffff}'));
    }
}
