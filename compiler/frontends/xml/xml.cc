#include "compiler/frontends/xml/xml.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>

namespace plumb::compiler {

std::string_view LocalName(const tinyxml2::XMLElement& element) {
  const std::string_view name = element.Name();
  const size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

const tinyxml2::XMLElement* ParseXml(std::string_view text, const std::string& file_name, std::string_view root, tinyxml2::XMLDocument& document,
                                     DiagnosticSink& sink) {
  SourceLocation where;
  where.type = "XML of";
  where.guid = file_name;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    where.line = static_cast<uint32_t>(std::max(0, document.ErrorLineNum()));
    sink.Emit(document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED ? DiagnosticKind::kXmlTooDeep : DiagnosticKind::kXmlSyntax, where,
              fmt::format("`{}` is no XML that can be read: {}", file_name, document.ErrorName()));
    return nullptr;
  }
  const tinyxml2::XMLElement* found = document.RootElement();
  if (found != nullptr && LocalName(*found) == root) return found;
  where.line = 1;
  sink.Emit(DiagnosticKind::kXmlSyntax, where, fmt::format("`{}` has no <{}> element", file_name, root));
  return nullptr;
}

}  // namespace plumb::compiler
