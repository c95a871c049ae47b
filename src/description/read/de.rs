//! A `serde::Deserializer` over the syntax tree, whose errors know their node.
//!
//! It is stricter than the formats where that helps (maps in the brackets RON wants, whole numbers in
//! range) and reads a `Hole`, a value that has been reported already, as anything.

use super::fault::{Fault, Located};
use crate::description::tree::{Entry, Node, Span, Style, Value, unwrapped};
use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor};
use serde::forward_to_deserialize_any;

static HOLE: Node = Node { value: Value::Hole, span: Span { source: 0, start: 0, end: 0 } };

type Read<T> = Result<T, Located>;

#[derive(Clone, Copy)]
pub(super) struct De<'a>(pub &'a Node);

fn expected<T>(what: impl Into<String>) -> Read<T> {
    Err(Fault::Type(what.into()).into())
}

fn whole<'de, V: Visitor<'de>>(
    node: &Node,
    range: std::ops::RangeInclusive<i128>,
    visitor: V,
) -> Read<V::Value> {
    match node.value {
        Value::Hole => visitor.visit_u64(0),
        Value::Int(i) if range.contains(&i) && i < 0 => visitor.visit_i64(i as i64),
        Value::Int(i) if range.contains(&i) => visitor.visit_u64(i as u64),
        _ => expected(format!("a whole number from {} to {}", range.start(), range.end())),
    }
}

macro_rules! whole_numbers {
    ($($method:ident: $type:ty),*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
            whole(self.0, <$type>::MIN.into()..=<$type>::MAX.into(), visitor)
        }
    )*};
}

impl<'de> Deserializer<'de> for De<'de> {
    type Error = Located;

    whole_numbers!(deserialize_u8: u8, deserialize_u16: u16, deserialize_u32: u32, deserialize_u64: u64,
        deserialize_i8: i8, deserialize_i16: i16, deserialize_i32: i32, deserialize_i64: i64);

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match &self.0.value {
            Value::Hole => visitor.visit_f64(0.0),
            Value::Bool(b) => visitor.visit_bool(*b),
            Value::Int(i) => visitor.visit_f64(*i as f64),
            Value::Float(x) => visitor.visit_f64(*x),
            Value::Str(s) | Value::Bare(s) => visitor.visit_borrowed_str(s),
            Value::Seq(_) => self.deserialize_seq(visitor),
            Value::Map(entries, _) => visit_entries(entries, visitor),
            Value::Word(_) | Value::Tagged(..) => visitor.visit_enum(Enum(self.0)),
            Value::Other(_) => visitor.visit_unit(),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match self.0.value {
            Value::Bool(b) => visitor.visit_bool(b),
            Value::Hole => visitor.visit_bool(false),
            _ => expected("true or false"),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match self.0.value {
            Value::Int(i) => visitor.visit_f64(i as f64),
            Value::Float(x) => visitor.visit_f64(x),
            Value::Hole => visitor.visit_f64(0.0),
            _ => expected("a number"),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match &self.0.value {
            Value::Str(s) | Value::Bare(s) => visitor.visit_borrowed_str(s),
            Value::Hole => visitor.visit_borrowed_str(""),
            _ => expected("a text in quotes"),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match &self.0.value {
            Value::Hole => visitor.visit_none(),
            Value::Word(word) | Value::Bare(word) if word == "None" => visitor.visit_none(),
            Value::Tagged(tag, _, content) if tag == "Some" => {
                let inner = unwrapped(content);
                let steps = if std::ptr::eq(inner, &**content) { 1 } else { 2 };
                visitor.visit_some(De(inner)).map_err(|e| (0..steps).fold(e, |e, _| e.under(0)))
            }
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match &self.0.value {
            Value::Seq(items) => {
                let mut access = Items { items, next: 0 };
                let value = visitor.visit_seq(&mut access)?;
                // what the type did not ask for is too much
                if access.next < items.len() {
                    expected(format!("{} values", access.next))
                } else {
                    Ok(value)
                }
            }
            Value::Map(entries, Style::Fields) if entries.is_empty() => {
                visitor.visit_seq(&mut Items { items: &[], next: 0 })
            }
            Value::Hole => visitor.visit_seq(&mut Items { items: &[], next: 0 }),
            _ => expected("a list [ ]"),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Read<V::Value> {
        match &self.0.value {
            Value::Seq(items) if items.len() == len => self.deserialize_seq(visitor),
            Value::Hole => visitor.visit_seq(Holes(len)),
            _ => expected(format!("{len} values")),
        }
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        match &self.0.value {
            Value::Map(entries, Style::Fields) if !entries.is_empty() => {
                Err(Fault::Brackets("{ \"name\": … }").into())
            }
            Value::Map(entries, _) => visit_entries(entries, visitor),
            Value::Hole => visit_entries(&[], visitor),
            _ => expected("a map from names to entries"),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Read<V::Value> {
        match &self.0.value {
            Value::Tagged(tag, _, content) if tag == name => {
                De(content).deserialize_struct("", fields, visitor).map_err(|e| e.under(0))
            }
            _ => visit_fields(self.0, fields, visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Read<V::Value> {
        match &self.0.value {
            Value::Hole => visitor.visit_enum(HoleEnum(variants[0])),
            Value::Word(_) | Value::Bare(_) | Value::Tagged(..) => visitor.visit_enum(Enum(self.0)),
            // TOML: a unit variant, or a table whose one key is the variant
            Value::Str(_) => visitor.visit_enum(Enum(self.0)),
            Value::Map(entries, Style::Table) if entries.len() == 1 => visitor.visit_enum(Enum(self.0)),
            Value::Map(entries, Style::Table) if entries.len() > 1 => {
                let names: Vec<&str> = entries.iter().map(|e| e.key.as_str()).collect();
                Err(Fault::Type(format!("one of {}, not {} together", one_of(variants), one_of(&names)))
                    .into())
            }
            _ => expected(format!("one of {}", one_of(variants))),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Read<V::Value> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        i128 u128 f32 char bytes byte_buf unit unit_struct tuple_struct identifier
    }
}

pub(super) fn one_of(names: &[&str]) -> String {
    crate::description::suggest::listed(names.iter().copied())
}

fn visit_entries<'de, V: Visitor<'de>>(entries: &'de [Entry], visitor: V) -> Read<V::Value> {
    visitor.visit_map(Entries { entries, next: 0 })
}

fn visit_fields<'de, V: Visitor<'de>>(
    node: &'de Node,
    fields: &'static [&'static str],
    visitor: V,
) -> Read<V::Value> {
    match &node.value {
        Value::Map(entries, Style::Braces) if !entries.is_empty() => {
            Err(Fault::Brackets("(field: …)").into())
        }
        Value::Map(entries, _) => visit_entries(entries, visitor),
        Value::Hole => visitor.visit_map(HoleFields(fields)),
        _ => expected(format!("fields of {}", one_of(fields))),
    }
}

struct Items<'a> {
    items: &'a [Node],
    next: usize,
}

impl<'de> SeqAccess<'de> for &mut Items<'de> {
    type Error = Located;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Read<Option<T::Value>> {
        let Some(item) = self.items.get(self.next) else { return Ok(None) };
        self.next += 1;
        seed.deserialize(De(item)).map(Some).map_err(|e| e.under(self.next - 1))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len() - self.next)
    }
}

struct Entries<'a> {
    entries: &'a [Entry],
    next: usize,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Located;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Read<Option<K::Value>> {
        let Some(entry) = self.entries.get(self.next) else { return Ok(None) };
        self.next += 1;
        seed.deserialize(StrDeserializer::new(&entry.key))
            .map(Some)
            .map_err(|e: Located| e.under(self.next - 1))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Read<V::Value> {
        let index = self.next - 1;
        seed.deserialize(De(&self.entries[index].node)).map_err(|e| e.under(index))
    }
}

/// `word`, `tag(…)`, or a table of one key.
struct Enum<'a>(&'a Node);

impl<'de> EnumAccess<'de> for Enum<'de> {
    type Error = Located;
    type Variant = Variant<'de>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Read<(V::Value, Variant<'de>)> {
        let (tag, content) = match &self.0.value {
            Value::Word(tag) | Value::Bare(tag) | Value::Str(tag) => (tag, None),
            Value::Tagged(tag, _, content) => (tag, Some(&**content)),
            Value::Map(entries, _) if !entries.is_empty() => (&entries[0].key, Some(&entries[0].node)),
            _ => return expected("a variant"),
        };
        let value = seed.deserialize(StrDeserializer::<Located>::new(tag))?;
        Ok((value, Variant { tag, content, tagged: matches!(self.0.value, Value::Tagged(..)) }))
    }
}

struct Variant<'a> {
    tag: &'a str,
    content: Option<&'a Node>,
    tagged: bool,
}

impl<'a> Variant<'a> {
    fn content(&self) -> Read<&'a Node> {
        self.content.ok_or_else(|| Fault::FieldsMissing(self.tag.into()).into())
    }
}

impl<'de> VariantAccess<'de> for Variant<'de> {
    type Error = Located;

    fn unit_variant(self) -> Read<()> {
        match self.content.map(|c| &c.value) {
            None | Some(Value::Hole) => Ok(()),
            Some(_) => expected(format!("`{}` alone", self.tag)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Read<T::Value> {
        let content = self.content()?;
        let inner = if self.tagged { unwrapped(content) } else { content };
        let steps = if std::ptr::eq(inner, content) { 1 } else { 2 };
        seed.deserialize(De(inner)).map_err(|e| (0..steps).fold(e, |e, _| e.under(0)))
    }

    fn tuple_variant<V: Visitor<'de>>(self, len: usize, visitor: V) -> Read<V::Value> {
        De(self.content()?).deserialize_tuple(len, visitor).map_err(|e| e.under(0))
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Read<V::Value> {
        visit_fields(self.content()?, fields, visitor).map_err(|e| e.under(0))
    }
}

/// As many holes as are asked for.
struct Holes(usize);

impl<'de> SeqAccess<'de> for Holes {
    type Error = Located;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Read<Option<T::Value>> {
        if self.0 == 0 {
            return Ok(None);
        }
        self.0 -= 1;
        seed.deserialize(De(&HOLE)).map(Some)
    }
}

/// Every field, each a hole.
struct HoleFields(&'static [&'static str]);

impl<'de> MapAccess<'de> for HoleFields {
    type Error = Located;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Read<Option<K::Value>> {
        let Some((first, rest)) = self.0.split_first() else { return Ok(None) };
        self.0 = rest;
        seed.deserialize(StrDeserializer::new(first)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Read<V::Value> {
        seed.deserialize(De(&HOLE))
    }
}

struct HoleEnum(&'static str);

impl<'de> EnumAccess<'de> for HoleEnum {
    type Error = Located;
    type Variant = Variant<'de>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Read<(V::Value, Variant<'de>)> {
        let value = seed.deserialize(StrDeserializer::<Located>::new(self.0))?;
        Ok((value, Variant { tag: self.0, content: Some(&HOLE), tagged: false }))
    }
}
