// What the names of objects say that these are.
#pragma once

#include <string_view>

namespace plumb::compiler {

enum class NameHint { kNone, kWall, kDoor, kWindow, kFurnishing };

// By words of English, German, French, Spanish and Italian within the name, in any case.
[[nodiscard]] NameHint HintOfName(std::string_view name);

}  // namespace plumb::compiler
