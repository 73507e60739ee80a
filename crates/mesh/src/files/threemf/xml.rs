//! The elements of an XML text, one at a time.

use std::io::BufRead;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::failure::Failure;
use crate::files::text::abridged;

/// The elements of a part of the package, in order.
pub(super) struct Elements<'a> {
    part: String,
    reader: Reader<Box<dyn BufRead + 'a>>,
    buffer: Vec<u8>,
}

/// An element, with its attributes.
pub(super) struct Element {
    /// The name without its prefix.
    pub(super) name: String,
    /// Whether it ends where it begins.
    is_empty: bool,
    /// Where it stands, for errors.
    place: String,
    attributes: Vec<(String, String)>,
}

/// The next step in a text.
enum Step {
    Begin(Element),
    End(String),
    Eof,
}

impl<'a> Elements<'a> {
    pub(super) fn new(part: &str, text: impl BufRead + 'a) -> Self {
        Self { part: part.to_owned(), reader: Reader::from_reader(Box::new(text)), buffer: Vec::new() }
    }

    /// The next element, wherever it is; `None` at the end of the text.
    pub(super) fn next(&mut self) -> Result<Option<Element>, Failure> {
        loop {
            match self.step()? {
                Step::Begin(element) => return Ok(Some(element)),
                Step::End(_) => {}
                Step::Eof => return Ok(None),
            }
        }
    }

    /// The next element within this one, which was read last or whose inner ones were; `None` at its end.
    pub(super) fn next_within(&mut self, outer: &Element) -> Result<Option<Element>, Failure> {
        if outer.is_empty {
            return Ok(None);
        }
        loop {
            match self.step()? {
                Step::Begin(element) => return Ok(Some(element)),
                Step::End(name) if name == outer.name => return Ok(None),
                Step::End(_) => {}
                Step::Eof => return Err(self.failure("the end of the text", &format!("`</{}>` is", outer.name))),
            }
        }
    }

    /// Skips the inside of the element that was read last.
    pub(super) fn skip(&mut self, outer: &Element) -> Result<(), Failure> {
        let mut depth = usize::from(!outer.is_empty);
        while depth > 0 {
            match self.step()? {
                Step::Begin(element) => depth += usize::from(!element.is_empty),
                Step::End(_) => depth -= 1,
                Step::Eof => return Err(self.failure("the end of the text", &format!("`</{}>` is", outer.name))),
            }
        }
        Ok(())
    }

    fn step(&mut self) -> Result<Step, Failure> {
        loop {
            self.buffer.clear();
            let event = self.reader.read_event_into(&mut self.buffer);
            let (start, is_empty) = match event {
                Ok(Event::Start(start)) => (start, false),
                Ok(Event::Empty(start)) => (start, true),
                Ok(Event::End(end)) => {
                    return Ok(Step::End(String::from_utf8_lossy(end.local_name().as_ref()).into_owned()));
                }
                Ok(Event::Eof) => return Ok(Step::Eof),
                Ok(_) => continue,
                Err(error) => {
                    let error = error.to_string();
                    return Err(self.failure(&error, "well-formed XML is"));
                }
            };
            let place = format!("{}, byte {}", self.part, self.reader.buffer_position());
            return element(&start, is_empty, place).map(Step::Begin);
        }
    }

    fn failure(&self, found: &str, expected: &str) -> Failure {
        Failure::new(&format!("{}, byte {}", self.part, self.reader.buffer_position()), found, expected)
    }
}

fn element(start: &BytesStart, is_empty: bool, place: String) -> Result<Element, Failure> {
    let name = String::from_utf8_lossy(start.local_name().as_ref()).into_owned();
    let mut attributes = Vec::new();
    for attribute in start.attributes().with_checks(false) {
        let malformed = |error: String| Failure::new(&place, error, "attributes as name=\"value\" are");
        let attribute = attribute.map_err(|error| malformed(error.to_string()))?;
        let value = attribute.decoded_and_normalized_value(XmlVersion::Implicit1_0, start.decoder());
        let value = value.map_err(|error| malformed(error.to_string()))?.into_owned();
        // Prefixes matter for the names of namespaces alone.
        let key = String::from_utf8_lossy(attribute.key.as_ref()).into_owned();
        let key = match key.split_once(':') {
            Some((prefix, local)) if prefix != "xmlns" => local.to_owned(),
            _ => key,
        };
        attributes.push((key, value));
    }
    Ok(Element { name, is_empty, place, attributes })
}

impl Element {
    /// The value of an attribute.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    pub(super) fn required(&self, key: &str) -> Result<&str, Failure> {
        self.get(key).ok_or_else(|| self.failure(&format!("no `{key}`"), "it is"))
    }

    /// A whole number from 0 on.
    pub(super) fn number(&self, key: &str) -> Result<u32, Failure> {
        let text = self.required(key)?;
        text.trim().parse().map_err(|_| {
            self.failure(&format!("`{key}` {:?}", abridged(text, "")), &format!("a number from 0 to {} is", u32::MAX))
        })
    }

    /// [`number`](Self::number), if it is there.
    pub(super) fn optional(&self, key: &str) -> Result<Option<u32>, Failure> {
        self.get(key).map(|_| self.number(key)).transpose()
    }

    /// A finite number.
    pub(super) fn real(&self, key: &str) -> Result<f64, Failure> {
        let text = self.required(key)?;
        text.trim()
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| self.failure(&format!("`{key}` {:?}", abridged(text, "")), "a finite number is"))
    }

    /// The failure of this element.
    pub(super) fn failure(&self, found: &str, expected: &str) -> Failure {
        Failure::new(&format!("{}: `{}`", self.place, abridged(&self.name, "")), found, expected)
    }
}
