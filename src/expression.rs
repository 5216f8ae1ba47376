//! Formulas in a case file: a number from the place and the time, such as `-10*(1 + 0.1*x)*sin(2*pi*t)`.
//!
//! Operators are `+ - * / ^` with the usual precedence, `^` from right to left and before a sign; angles are in radians.

use std::fmt;
use std::sync::Arc;

/// The most characters of a formula, and the deepest that its parts are within each other: one from an unknown source costs no memory.
const LONGEST: usize = 1000;
const DEEPEST: usize = 64;

/// What a formula may name.
const VARIABLES: [&str; 3] = ["x", "y", "t"];

type Unary = fn(f64) -> f64;
type Binary = fn(f64, f64) -> f64;

const UNARY: [(&str, Unary); 11] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("atan", f64::atan),
    ("tanh", f64::tanh),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
    ("sign", |a| if a == 0.0 { 0.0 } else { a.signum() }),
    ("step", |a| if a < 0.0 { 0.0 } else { 1.0 }),
];
const BINARY: [(&str, Binary); 2] = [("min", f64::min), ("max", f64::max)];

/// A formula in `x`, `y` (m) and `t` (s).
#[derive(Clone)]
pub struct Expression {
    text: String,
    root: Arc<Node>,
}

enum Node {
    Number(f64),
    Variable(usize),
    Unary(Unary, Box<Node>),
    Binary(Binary, Box<[Node; 2]>),
}

impl Expression {
    /// Reads a formula.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.len() > LONGEST {
            return Err(format!("it has more than {LONGEST} characters"));
        }
        let mut parser = Parser { text, at: 0, depth: 0 };
        let root = parser.sum()?;
        match parser.next() {
            None => Ok(Self { text: text.to_owned(), root: Arc::new(root) }),
            Some(c) => Err(parser.unexpected(c)),
        }
    }

    /// Its value at a place (m) and a time (s).
    pub fn at(&self, [x, y]: [f64; 2], t: f64) -> f64 {
        self.root.at(&[x, y, t])
    }

    /// Whether it names the time.
    pub fn varies_in_time(&self) -> bool {
        self.root.names(2)
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Expression({})", self.text)
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Node {
    fn at(&self, variables: &[f64; 3]) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Variable(k) => variables[*k],
            Self::Unary(f, a) => f(a.at(variables)),
            Self::Binary(f, both) => f(both[0].at(variables), both[1].at(variables)),
        }
    }

    fn names(&self, variable: usize) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Variable(k) => *k == variable,
            Self::Unary(_, a) => a.names(variable),
            Self::Binary(_, both) => both.iter().any(|a| a.names(variable)),
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    /// The next character that is no space.
    fn next(&mut self) -> Option<char> {
        let spaces = self.rest().len() - self.rest().trim_start().len();
        self.at += spaces;
        self.rest().chars().next()
    }

    /// Takes the next character if it is this one.
    fn take(&mut self, wanted: char) -> bool {
        let found = self.next() == Some(wanted);
        self.at += if found { wanted.len_utf8() } else { 0 };
        found
    }

    fn unexpected(&self, c: char) -> String {
        format!("`{}` is not expected as character {}", c.escape_debug(), self.text[..self.at].chars().count() + 1)
    }

    fn binary(f: Binary, a: Node, b: Node) -> Node {
        Node::Binary(f, Box::new([a, b]))
    }

    fn sum(&mut self) -> Result<Node, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("its parts are more than {DEEPEST} deep within each other"));
        }
        let mut node = self.product()?;
        loop {
            if self.take('+') {
                node = Self::binary(|a, b| a + b, node, self.product()?);
            } else if self.take('-') {
                node = Self::binary(|a, b| a - b, node, self.product()?);
            } else {
                self.depth -= 1;
                return Ok(node);
            }
        }
    }

    fn product(&mut self) -> Result<Node, String> {
        let mut node = self.signed()?;
        loop {
            if self.take('*') {
                node = Self::binary(|a, b| a * b, node, self.signed()?);
            } else if self.take('/') {
                node = Self::binary(|a, b| a / b, node, self.signed()?);
            } else {
                return Ok(node);
            }
        }
    }

    fn signed(&mut self) -> Result<Node, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(format!("its parts are more than {DEEPEST} deep within each other"));
        }
        let node = if self.take('-') {
            Node::Unary(|a| -a, Box::new(self.signed()?))
        } else if self.take('+') {
            self.signed()?
        } else {
            let base = self.value()?;
            if self.take('^') { Self::binary(f64::powf, base, self.signed()?) } else { base }
        };
        self.depth -= 1;
        Ok(node)
    }

    fn value(&mut self) -> Result<Node, String> {
        match self.next() {
            Some('(') => {
                self.at += 1;
                let node = self.sum()?;
                self.close()?;
                Ok(node)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(c),
            Some(c) if c.is_ascii_alphabetic() => self.named(),
            Some(c) => Err(self.unexpected(c)),
            None => Err("it ends where a value is expected".to_owned()),
        }
    }

    fn close(&mut self) -> Result<(), String> {
        if self.take(')') {
            return Ok(());
        }
        Err(self.next().map_or_else(|| "a `)` is missing at its end".to_owned(), |c| self.unexpected(c)))
    }

    fn number(&mut self, first: char) -> Result<Node, String> {
        let rest = self.rest();
        let mut end = 0;
        let mut before = ' ';
        for c in rest.chars() {
            let of_exponent = matches!(before, 'e' | 'E') && matches!(c, '+' | '-');
            if !(c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E') || of_exponent) {
                break;
            }
            (before, end) = (c, end + 1);
        }
        let value = rest[..end].parse().map_err(|_| self.unexpected(first))?;
        self.at += end;
        Ok(Node::Number(value))
    }

    fn named(&mut self) -> Result<Node, String> {
        let rest = self.rest();
        let name = rest[..rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len())].to_owned();
        self.at += name.len();
        if let Some(k) = VARIABLES.iter().position(|known| *known == name) {
            return Ok(Node::Variable(k));
        }
        if name == "pi" {
            return Ok(Node::Number(std::f64::consts::PI));
        }
        let unary = UNARY.iter().find(|(known, _)| *known == name).map(|(_, f)| *f);
        let binary = BINARY.iter().find(|(known, _)| *known == name).map(|(_, f)| *f);
        if unary.is_none() && binary.is_none() {
            let functions = UNARY.iter().map(|(name, _)| *name).chain(BINARY.iter().map(|(name, _)| *name));
            let known: Vec<&str> = VARIABLES.into_iter().chain(["pi"]).chain(functions).collect();
            return Err(format!("it names `{name}`; known are {}", known.join(", ")));
        }
        if !self.take('(') {
            return Err(format!("`{name}` is a function, and a `(` has to follow"));
        }
        let first = self.sum()?;
        let node = match (unary, binary) {
            (Some(f), _) => Node::Unary(f, Box::new(first)),
            (None, Some(f)) if self.take(',') => Self::binary(f, first, self.sum()?),
            _ => return Err(format!("`{name}` has two arguments, parted by a comma")),
        };
        self.close()?;
        Ok(node)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Expression::parse(text).unwrap().at([3.0, -2.0], 0.5)
    }

    #[test]
    fn operators_have_their_precedence() {
        for (text, expected) in [
            ("1 + 2*3^2", 19.0),
            ("2^3^2", 512.0),
            ("-2^2", -4.0),
            ("2^-1", 0.5),
            ("8/4/2 - 1 - 1", -1.0),
            ("(1 + 2)*x", 9.0),
            ("-y*t", 1.0),
            ("1.5e1 + .5E-1", 15.05),
            ("max(x, min(y, 7)) + abs(y)", 5.0),
            ("step(t - 0.5) + step(t - 0.6) + sign(y)", 0.0),
            ("sqrt(exp(ln(16)))", 4.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-14, "{text}: {}", value(text));
        }
        assert!((value("-10*(1 + 0.1*x)*sin(pi*t)") + 13.0).abs() < 1e-14);
        assert!(
            Expression::parse("x*t").unwrap().varies_in_time() && !Expression::parse("x*y").unwrap().varies_in_time()
        );
    }

    #[test]
    fn mistakes_are_named() {
        let deep = "(".repeat(100);
        for (text, says) in [
            ("", "it ends where a value"),
            ("1 +", "it ends where a value"),
            ("(1", "a `)` is missing"),
            ("1)", "`)` is not expected as character 2"),
            ("2 x", "`x` is not expected as character 3"),
            ("1.2.3", "`1` is not expected as character 1"),
            ("z + 1", "it names `z`; known are x, y, t, pi, sin"),
            ("sin x", "`sin` is a function"),
            ("min(x)", "`min` has two arguments"),
            ("é", "`é` is not expected as character 1"),
            (&deep, "more than 64 deep"),
            (&"1+".repeat(600), "more than 1000 characters"),
        ] {
            let found = Expression::parse(text).unwrap_err();
            assert!(found.contains(says), "{text}: {found}");
        }
    }
}
