// How doors open by the names that IFC gives it: IfcDoorTypeOperationEnum, IfcDoorStyleOperationEnum, and people's own words.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/geometry/door_swings.h"

namespace plumb::compiler {

// In the frame of the door or its type, in which "left" is low x (of who looks along y) and doors open along y.

// By the name of the enumerator, of any release ("DOUBLE_DOOR_...", since IFC4X3 also "DOUBLE_PANEL_..."); from left to right. Empty for
// NOTDEFINED, USERDEFINED and names that are none.
[[nodiscard]] std::vector<FramedLeaf> LeavesByOperation(std::string_view name);

// By UserDefinedOperationType: the name of an enumerator in any writing ("Single swing left"), else a word for how it moves ("sliding").
[[nodiscard]] std::vector<FramedLeaf> LeavesByWords(std::string_view text);

}  // namespace plumb::compiler
