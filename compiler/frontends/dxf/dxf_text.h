// Texts of DXF as people read them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb::compiler {

// UTF-8 as it is; anything else is taken for Windows' western code page. `\U+00FC` becomes its letter.
[[nodiscard]] std::string DecodeDxfText(std::string_view text);
[[nodiscard]] std::string PlainText(std::string_view text);                // TEXT: without %%u and the like
[[nodiscard]] std::vector<std::string> PlainLines(std::string_view text);  // MTEXT: without formatting, by paragraphs

}  // namespace plumb::compiler
