#include "compiler/frontends/xml/xml.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>

namespace plumb::compiler {

namespace {

// Of the library's names of errors people know nothing.
std::string_view Fault(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT: return "there is nothing in it";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT: return "an element is not closed, or closed by the tag of another one";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT: return "a tag is not well formed";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE: return "an attribute is not well formed";
    case tinyxml2::XML_ERROR_PARSING_TEXT: return "a text does not end";
    case tinyxml2::XML_ERROR_PARSING_CDATA: return "a CDATA section does not end";
    case tinyxml2::XML_ERROR_PARSING_COMMENT: return "a comment does not end";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION: return "a declaration stands in a wrong place or does not end";
    case tinyxml2::XML_ERROR_PARSING_UNKNOWN: return "something in angle brackets does not end";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED: return "elements stand in elements too deeply";
    default: return "it is not well formed, or cut off";
  }
}

}  // namespace

std::string_view LocalName(const tinyxml2::XMLElement& element) {
  const std::string_view name = element.Name();
  const size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

const tinyxml2::XMLElement* ParseXml(std::string_view text, const std::string& file_name, std::string_view root,
                                     tinyxml2::XMLDocument& document, DiagnosticSink& sink) {
  SourceLocation where;
  where.type = "XML of";
  where.guid = file_name;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    where.line = static_cast<uint32_t>(std::max(0, document.ErrorLineNum()));
    sink.Emit(document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED ? DiagnosticKind::kXmlTooDeep : DiagnosticKind::kXmlSyntax, where,
              fmt::format("`{}` is no XML that can be read: {}", file_name, Fault(document.ErrorID())));
    return nullptr;
  }
  const tinyxml2::XMLElement* found = document.RootElement();
  if (found != nullptr && LocalName(*found) == root) return found;
  where.line = 1;
  sink.Emit(DiagnosticKind::kXmlSyntax, where, fmt::format("`{}` has no <{}> element", file_name, root));
  return nullptr;
}

}  // namespace plumb::compiler
