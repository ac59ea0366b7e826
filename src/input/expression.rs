//! Expressions of one or more variables, as HOHQMesh's control files have them: a Pratt parser and evaluation
//! together with the derivative by the first variable (forward mode).
//!
//! Operators + − * / ^ ** with the usual precedence; power binds tighter than the sign, so −t^2 is
//! −(t²), and associates to the right. Case does not matter; exponents may be Fortran's (1.0d0).

use crate::error::{Error, Result};

/// A parsed expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    program: Vec<Op>,
}

/// Instructions of a stack machine.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Op {
    Number(f64),
    Variable(u8),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
    Call(Function),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Atanh,
    Exp,
    Log,
    Log10,
    Sqrt,
    Abs,
}

impl Function {
    fn named(name: &str) -> Option<Self> {
        use Function::*;
        Some(match name {
            "sin" => Sin,
            "cos" => Cos,
            "tan" => Tan,
            "asin" => Asin,
            "acos" => Acos,
            "atan" => Atan,
            "sinh" => Sinh,
            "cosh" => Cosh,
            "tanh" => Tanh,
            "atanh" => Atanh,
            "exp" => Exp,
            "log" | "ln" => Log,
            "log10" => Log10,
            "sqrt" => Sqrt,
            "abs" => Abs,
            _ => return None,
        })
    }

    /// Value and derivative at `x`.
    fn evaluate(self, x: f64) -> (f64, f64) {
        use Function::*;
        match self {
            Sin => (x.sin(), x.cos()),
            Cos => (x.cos(), -x.sin()),
            Tan => (x.tan(), 1.0 / x.cos().powi(2)),
            Asin => (x.asin(), 1.0 / (1.0 - x * x).sqrt()),
            Acos => (x.acos(), -1.0 / (1.0 - x * x).sqrt()),
            Atan => (x.atan(), 1.0 / (1.0 + x * x)),
            Sinh => (x.sinh(), x.cosh()),
            Cosh => (x.cosh(), x.sinh()),
            Tanh => (x.tanh(), 1.0 / x.cosh().powi(2)),
            Atanh => (x.atanh(), 1.0 / (1.0 - x * x)),
            Exp => (x.exp(), x.exp()),
            Log => (x.ln(), 1.0 / x),
            Log10 => (x.log10(), 1.0 / (x * std::f64::consts::LN_10)),
            Sqrt => (x.sqrt(), 0.5 / x.sqrt()),
            Abs => (x.abs(), if x == 0.0 { 0.0 } else { x.signum() }),
        }
    }
}

/// Value and derivative of a power; a negative base is fine with an integer exponent.
fn power((a, da): (f64, f64), (b, db): (f64, f64)) -> (f64, f64) {
    let pow = |e: f64| if e.fract() == 0.0 && e.abs() <= 1024.0 { a.powi(e as i32) } else { a.powf(e) };
    let value = pow(b);
    let mut derivative = 0.0;
    if da != 0.0 && b != 0.0 {
        derivative += b * pow(b - 1.0) * da;
    }
    if db != 0.0 {
        derivative += value * a.ln() * db;
    }
    (value, derivative)
}

impl Expression {
    /// Parses `text`, an expression of the variable `variable`. `line` and `column` (from 1) tell where
    /// in its file it begins: errors are located in the file.
    pub fn parse(text: &str, variable: &str, line: usize, column: usize) -> Result<Self> {
        Self::parse_of(text, &[variable], line, column)
    }

    /// The same for an expression of several variables (up to 256).
    pub fn parse_of(text: &str, variables: &[&str], line: usize, column: usize) -> Result<Self> {
        let variables: Vec<String> = variables.iter().map(|v| v.to_lowercase()).collect();
        let mut parser = Parser::new(text, &variables, line, column);
        parser.sum(0)?;
        parser.skip_blanks();
        if parser.at < parser.text.len() {
            return Err(parser.error("an operator is missing here"));
        }
        Ok(Expression { program: parser.program })
    }

    /// Parses an equation `name(variable) = expression`.
    pub fn parse_equation(text: &str, line: usize, column: usize) -> Result<Self> {
        let at = |offset: usize, what: &str| {
            let column = column + text[..offset].chars().count();
            Err(Error::Parse { what: what.to_string(), line, column })
        };
        let Some(equals) = text.find('=') else { return at(0, "an equation needs the form x(t) = ...") };
        let head = text[..equals].trim();
        let variable = head.split_once('(').and_then(|(name, rest)| {
            let variable = rest.trim().strip_suffix(')')?.trim();
            (is_name(name.trim()) && is_name(variable)).then_some(variable)
        });
        let Some(variable) = variable else {
            return at(0, "the left side of an equation must have the form x(t)");
        };
        let body = column + text[..=equals].chars().count();
        Self::parse(&text[equals + 1..], variable, line, body)
    }

    /// Value and derivative at `t`. Where the expression is undefined both may be NaN or infinite.
    pub fn evaluate(&self, t: f64) -> (f64, f64) {
        self.run(&[t])
    }

    /// Value for these variables, in the order they were named. NaN or infinite where it is undefined.
    pub fn value(&self, variables: &[f64]) -> f64 {
        self.run(variables).0
    }

    /// Value, and derivative by the first variable.
    fn run(&self, variables: &[f64]) -> (f64, f64) {
        let mut stack: Vec<(f64, f64)> = Vec::with_capacity(16);
        for op in &self.program {
            let value = match *op {
                Op::Number(x) => (x, 0.0),
                Op::Variable(k) => {
                    let value = variables.get(k as usize).copied().unwrap_or(f64::NAN);
                    (value, if k == 0 { 1.0 } else { 0.0 })
                }
                Op::Negate => {
                    let (a, da) = stack.pop().unwrap_or_default();
                    (-a, -da)
                }
                Op::Call(f) => {
                    let (a, da) = stack.pop().unwrap_or_default();
                    let (value, slope) = f.evaluate(a);
                    (value, if da == 0.0 { 0.0 } else { slope * da })
                }
                binary => {
                    let (b, db) = stack.pop().unwrap_or_default();
                    let (a, da) = stack.pop().unwrap_or_default();
                    match binary {
                        Op::Add => (a + b, da + db),
                        Op::Subtract => (a - b, da - db),
                        Op::Multiply => (a * b, da * b + a * db),
                        Op::Divide => (a / b, (da - a / b * db) / b),
                        // A NaN stays one.
                        Op::Min if a < b || a.is_nan() => (a, da),
                        Op::Max if a > b || a.is_nan() => (a, da),
                        Op::Min | Op::Max => (b, db),
                        _ => power((a, da), (b, db)),
                    }
                }
            };
            stack.push(value);
        }
        stack.pop().unwrap_or_default()
    }
}

fn is_name(s: &str) -> bool {
    s.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && s.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

struct Parser<'a> {
    text: Vec<char>,
    at: usize,
    variables: &'a [String],
    program: Vec<Op>,
    depth: usize,
    line: usize,
    column: usize,
}

/// Deepest nesting accepted; keeps the recursion off the stack's end.
const MAX_DEPTH: usize = 200;

/// Binding strength of the sign: below power, above product.
const SIGN: u8 = 3;

impl<'a> Parser<'a> {
    fn new(text: &str, variables: &'a [String], line: usize, column: usize) -> Self {
        let text = text.chars().map(|c| c.to_ascii_lowercase()).collect();
        Parser { text, at: 0, variables, program: Vec::new(), depth: 0, line, column }
    }

    fn error(&self, what: impl Into<String>) -> Error {
        Error::Parse { what: what.into(), line: self.line, column: self.column + self.at }
    }

    fn peek(&self) -> Option<char> {
        self.text.get(self.at).copied()
    }

    fn skip_blanks(&mut self) {
        while self.peek().is_some_and(char::is_whitespace) {
            self.at += 1;
        }
    }

    /// Parses operands and operators that bind at least as tightly as `least`.
    fn sum(&mut self, least: u8) -> Result<()> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error("the expression is nested too deeply"));
        }
        self.operand()?;
        loop {
            self.skip_blanks();
            let double = self.peek() == Some('*') && self.text.get(self.at + 1) == Some(&'*');
            // (operator, its strength, that of its right operand)
            let (op, strength, right) = match self.peek() {
                Some('+') => (Op::Add, 1, 2),
                Some('-') => (Op::Subtract, 1, 2),
                Some('*') if !double => (Op::Multiply, 2, 3),
                Some('/') => (Op::Divide, 2, 3),
                // To the right, and an exponent may carry a sign.
                Some('^' | '*') => (Op::Power, 4, 4),
                _ => break,
            };
            if strength < least {
                break;
            }
            self.at += if double { 2 } else { 1 };
            self.sum(right)?;
            self.program.push(op);
        }
        self.depth -= 1;
        Ok(())
    }

    fn operand(&mut self) -> Result<()> {
        self.skip_blanks();
        match self.peek() {
            Some('+') => {
                self.at += 1;
                self.sum(SIGN)
            }
            Some('-') => {
                self.at += 1;
                self.sum(SIGN)?;
                self.program.push(Op::Negate);
                Ok(())
            }
            Some('(') => {
                self.at += 1;
                self.sum(0)?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() || c == '_' => self.name(),
            Some(c) => Err(self.error(format!("'{c}' cannot begin a term"))),
            None => Err(self.error("the expression ends where a term is expected")),
        }
    }

    fn close(&mut self) -> Result<()> {
        self.skip_blanks();
        if self.peek() != Some(')') {
            return Err(self.error("')' is missing"));
        }
        self.at += 1;
        Ok(())
    }

    fn digits(&mut self) {
        while self.peek().is_some_and(|c| c.is_ascii_digit()) {
            self.at += 1;
        }
    }

    fn number(&mut self) -> Result<()> {
        let start = self.at;
        self.digits();
        if self.peek() == Some('.') {
            self.at += 1;
            self.digits();
        }
        if matches!(self.peek(), Some('e' | 'd')) {
            let before = self.at;
            self.at += 1;
            if matches!(self.peek(), Some('+' | '-')) {
                self.at += 1;
            }
            let first = self.at;
            self.digits();
            if self.at == first {
                self.at = before;
            }
        }
        let text: String = self.text[start..self.at].iter().collect();
        match text.replace('d', "e").parse() {
            Ok(x) => {
                self.program.push(Op::Number(x));
                Ok(())
            }
            Err(_) => {
                self.at = start;
                Err(self.error(format!("'{text}' is not a number")))
            }
        }
    }

    fn name(&mut self) -> Result<()> {
        let start = self.at;
        while self.peek().is_some_and(|c| c.is_ascii_alphanumeric() || c == '_') {
            self.at += 1;
        }
        let name: String = self.text[start..self.at].iter().collect();
        if let Some(k) = self.variables.iter().position(|v| *v == name) {
            self.program.push(Op::Variable(k as u8));
            return Ok(());
        }
        if name == "pi" {
            self.program.push(Op::Number(std::f64::consts::PI));
            return Ok(());
        }
        let (op, two) = match (name.as_str(), Function::named(&name)) {
            ("min", _) => (Op::Min, true),
            ("max", _) => (Op::Max, true),
            (_, Some(function)) => (Op::Call(function), false),
            _ => {
                self.at = start;
                return Err(self.error(format!("unknown name '{name}'")));
            }
        };
        self.skip_blanks();
        if self.peek() != Some('(') {
            return Err(self.error(format!("'(' is missing after '{name}'")));
        }
        self.at += 1;
        self.sum(0)?;
        if two {
            if self.peek() != Some(',') {
                return Err(self.error(format!("',' is missing: '{name}' takes two values")));
            }
            self.at += 1;
            self.sum(0)?;
        }
        self.close()?;
        self.program.push(op);
        Ok(())
    }
}
