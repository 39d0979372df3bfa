#pragma once

#include <map>
#include <string>
#include <string_view>

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// What a schema's document leaves to the program, by name: lists of names, ranges of other code.
using GivenSchemas = std::map<std::string, Schema>;

/// A schema that a document holds as data: `name: VALUE` for each. A value is a phrase, a map of keys, or
/// [value, what the key says]. A key that ends with a question mark may be absent; of `(exactly one)` each
/// map has one. Phrases:
///
///     number, integer [from A | above A] [to B]    list of X, N of X, N or more X, N to M of X
///     boolean, text                                map of X: any keys; sided X: X, or left and right
///     one of WORD, WORD                            any of X, Y
///     X or null                                    NAME: of `given` or of the document
///
/// `open`: all its maps accept keys of any other name, as results do.
[[nodiscard]] Schema schema_in(std::string_view document, const std::string& name, bool open,
                               const GivenSchemas& given = {});

}  // namespace joulepath
