// What elements of an SVG are called: layers' labels, classes, ids.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb::compiler {

// What white space parts.
[[nodiscard]] std::vector<std::string> SvgWords(std::string_view text);

// The names of an element that tell what is drawn: `label` and `data_name` where they are stated, its classes, its id as it was before a
// program wrote it in the letters that an id may have. Ids that programs number are none.
[[nodiscard]] std::vector<std::string> SvgNames(std::string_view label, std::string_view data_name, const std::vector<std::string>& classes,
                                                std::string_view id);

}  // namespace plumb::compiler
