// XML of untrusted files, for the frontends that read it. tinyxml2 keeps entities that a file defines as they stand and ends at a nesting
// of 100 elements, so that neither grows beyond the file's size.
#pragma once

#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace plumb::compiler {

// The root element, whose name without a prefix must be `root`. Null: no XML, nested too deep, or another root, and an error says so.
// `file_name` is for messages.
[[nodiscard]] const tinyxml2::XMLElement* ParseXml(std::string_view text, const std::string& file_name, std::string_view root,
                                                   tinyxml2::XMLDocument& document, DiagnosticSink& sink);

// "svg:path" without its prefix.
[[nodiscard]] std::string_view LocalName(const tinyxml2::XMLElement& element);

}  // namespace plumb::compiler
