//! Values that know where they were written.

use crate::Span;

/// A name and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// The text.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

impl Name {
    /// A name that nobody wrote.
    pub fn new(text: impl Into<String>) -> Self {
        Name { text: text.into(), span: Span::NONE }
    }
}

/// A value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// What.
    pub value: Value,
    /// Where.
    pub span: Span,
}

/// The kinds of values that formats can say.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// true or false
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// Any number.
    Float(f64),
    /// A text or a name.
    Text(String),
    /// Several values.
    List(Vec<Node>),
    /// Named values.
    Map(Map),
}

impl Value {
    /// For messages: "a number", "a text" ...
    pub fn article(&self) -> &'static str {
        match self {
            Value::Bool(_) => "true or false",
            Value::Int(_) => "a whole number",
            Value::Float(_) => "a number",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Map(_) => "a table",
        }
    }
}

impl Node {
    /// A value that nobody wrote.
    pub fn new(value: impl Into<Value>) -> Self {
        Node { value: value.into(), span: Span::NONE }
    }

    /// A value with its place.
    pub fn spanned(value: impl Into<Value>, span: Span) -> Self {
        Node { value: value.into(), span }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            Value::Int(i) => Some(i as f64),
            Value::Float(f) => Some(f),
            _ => None,
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(t) => Some(t),
            _ => None,
        }
    }

    /// The items, if it is a list.
    pub fn list(&self) -> Option<&[Node]> {
        match &self.value {
            Value::List(l) => Some(l),
            _ => None,
        }
    }

    /// The entries, if it is a map.
    pub fn map(&self) -> Option<&Map> {
        match &self.value {
            Value::Map(m) => Some(m),
            _ => None,
        }
    }

    /// All items as numbers, if it is a list of `N` of them.
    pub fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let list = self.list()?;
        if list.len() != N {
            return None;
        }
        let mut out = [0.0; N];
        for (o, n) in out.iter_mut().zip(list) {
            *o = n.number()?;
        }
        Some(out)
    }
}

impl From<bool> for Value {
    fn from(v: bool) -> Self {
        Value::Bool(v)
    }
}
impl From<i64> for Value {
    fn from(v: i64) -> Self {
        Value::Int(v)
    }
}
impl From<f64> for Value {
    fn from(v: f64) -> Self {
        Value::Float(v)
    }
}
impl From<&str> for Value {
    fn from(v: &str) -> Self {
        Value::Text(v.into())
    }
}
impl From<String> for Value {
    fn from(v: String) -> Self {
        Value::Text(v)
    }
}
impl<const N: usize> From<[f64; N]> for Value {
    fn from(v: [f64; N]) -> Self {
        Value::List(v.iter().map(|&x| Node::new(x)).collect())
    }
}
impl From<Vec<Node>> for Value {
    fn from(v: Vec<Node>) -> Self {
        Value::List(v)
    }
}
impl From<Map> for Value {
    fn from(v: Map) -> Self {
        Value::Map(v)
    }
}

/// Named values in written order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Map(pub Vec<(Name, Node)>);

impl Map {
    /// Look one up.
    pub fn get(&self, name: &str) -> Option<&Node> {
        self.0.iter().find(|(n, _)| n.text == name).map(|(_, v)| v)
    }

    /// Look one up with its name.
    pub fn entry(&self, name: &str) -> Option<&(Name, Node)> {
        self.0.iter().find(|(n, _)| n.text == name)
    }

    /// Set or replace a value.
    pub fn set(&mut self, name: Name, node: Node) {
        match self.0.iter_mut().find(|(n, _)| n.text == name.text) {
            Some(slot) => slot.1 = node,
            None => self.0.push((name, node)),
        }
    }

    /// Set a value that nobody wrote; returns self for chaining.
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.set(Name::new(name), Node::new(value));
        self
    }

    /// Take a value out.
    pub fn remove(&mut self, name: &str) -> Option<Node> {
        let i = self.0.iter().position(|(n, _)| n.text == name)?;
        Some(self.0.remove(i).1)
    }

    /// In written order.
    pub fn iter(&self) -> impl Iterator<Item = &(Name, Node)> {
        self.0.iter()
    }
}
