// Notes on the drawing itself among its texts: scales, dates, titles, marks of sections.
#pragma once

#include <string_view>

namespace plumb::compiler {

// "Scale 1:100", "Date: 12.03.2019", "Ground floor plan", "Section A-A", "Rev. B", in English, German, French, Italian and Spanish. Rooms
// may be called by the same words: "Drawing office", "Projektraum", "Scala".
[[nodiscard]] bool IsNote(std::string_view text);

}  // namespace plumb::compiler
