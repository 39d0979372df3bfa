#pragma once

#include <string>

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// The kind of a document: from its schema line, else from a key that only one kind has; empty if unknown.
[[nodiscard]] std::string inferred_kind(const Node& root);

/// Checks the `schema:` line (absent: version 1 of the kind expected) and the whole document.
void check_document(const Document& document, const std::string& kind, const Schema& schema);

}  // namespace joulepath
