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
        Self(format!("<figure>{svg}{}</figure>\n", caption.0))
    }

    /// A picture as PNG, within the page.
    pub fn image(png: &[u8], width: u32, caption: &str) -> Self {
        let (data, caption) = (BASE64_STANDARD.encode(png), Self::text(caption).0);
        Self(format!(
            "<figure><img width=\"{width}\" alt=\"{caption}\" src=\"data:image/png;base64,{data}\"/><figcaption>{caption}</figcaption></figure>\n"
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
        let title = Self::text(title).0;
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src data:\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
            body.0
        )
    }
}

/// How pages look, on a screen and on paper.
const STYLE: &str = "
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin-bottom: 0.3rem; }
h2 { font-size: 1.2rem; margin: 2.2rem 0 0.6rem; border-bottom: 1px solid #bbb; }
h3 { font-size: 1rem; margin: 1.4rem 0 0.4rem; }
table { border-collapse: collapse; margin: 0.4rem 0 1rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: 0.2rem 0.9rem 0.2rem 0; border-bottom: 1px solid #ddd; overflow-wrap: anywhere; }
th:first-child, td:first-child { overflow-wrap: normal; }
th { border-bottom: 1px solid #777; }
figure { margin: 0.6rem 0; break-inside: avoid; }
figure svg, figure img { max-width: 100%; height: auto; }
figcaption { color: #555; font-size: 0.9rem; }
strong { color: #a33600; }
@media print {
  body { font-size: 10pt; margin: 0; max-width: none; }
  h2, h3 { break-after: avoid; }
  tr { break-inside: avoid; }
}
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stays_text() {
        let hostile = "</title><script>alert(\"1\")</script> ' & \u{1} \u{ffff}";
        let page = Html::page(hostile, &Html::of("p", hostile).and(Html::image(&[1, 2, 3], 10, hostile)));
        assert!(!page.contains("<script") && page.contains("&lt;script&gt;alert(&quot;1&quot;)"), "{page}");
        assert!(!page.chars().any(|c| c == '\u{1}' || c == '\u{ffff}'));
    }
}
