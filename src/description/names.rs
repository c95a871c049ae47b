//! A map from names to entries that keeps the file's order and refuses a name that is given twice.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt;
use std::marker::PhantomData;

/// Named entries in the order of the file.
#[derive(Clone, Debug)]
pub struct NameMap<T> {
    entries: Vec<(String, T)>,
    /// The position of each name.
    index: HashMap<String, usize>,
}

impl<T: PartialEq> PartialEq for NameMap<T> {
    fn eq(&self, other: &Self) -> bool {
        self.entries == other.entries
    }
}

impl<T> Default for NameMap<T> {
    fn default() -> Self {
        NameMap { entries: Vec::new(), index: HashMap::new() }
    }
}

impl<T> NameMap<T> {
    pub fn get(&self, name: &str) -> Option<&T> {
        self.index.get(name).map(|i| &self.entries[*i].1)
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.entries.iter().map(|(name, entry)| (name.as_str(), entry))
    }

    pub fn iter_mut(&mut self) -> impl Iterator<Item = (&str, &mut T)> {
        self.entries.iter_mut().map(|(name, entry)| (name.as_str(), entry))
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(name, _)| name.as_str())
    }

    pub fn len(&self) -> usize {
        self.entries.len()
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Keeps the entries for which `keep` holds.
    pub fn retain(&mut self, keep: impl Fn(&T) -> bool) {
        self.entries.retain(|(_, entry)| keep(entry));
        self.index = self.entries.iter().enumerate().map(|(i, (name, _))| (name.clone(), i)).collect();
    }

    /// Adds an entry; gives it back if the name is taken.
    pub fn insert(&mut self, name: String, entry: T) -> Result<(), T> {
        if self.index.contains_key(&name) {
            return Err(entry);
        }
        self.index.insert(name.clone(), self.entries.len());
        self.entries.push((name, entry));
        Ok(())
    }
}

impl<T: Serialize> Serialize for NameMap<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.entries.len()))?;
        for (name, entry) in &self.entries {
            map.serialize_entry(name, entry)?;
        }
        map.end()
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for NameMap<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = NameMap<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a map from names to entries")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<NameMap<T>, A::Error> {
                let mut map = NameMap::default();
                while let Some(name) = access.next_key::<String>()? {
                    if map.index.contains_key(&name) {
                        return Err(A::Error::custom(format!("the name `{name}` is given twice")));
                    }
                    map.index.insert(name.clone(), map.entries.len());
                    map.entries.push((name, access.next_value()?));
                }
                Ok(map)
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for NameMap<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Named{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let entry = generator.subschema_for::<T>();
        schemars::json_schema!({ "type": "object", "additionalProperties": entry })
    }
}
