// What a planar map is made of: the outlines of a floor, each with a number.
#pragma once

#include <cstdint>

#include "compiler/ir/floor_ir.h"
#include "compiler/passes/snap.h"

namespace plumb::compiler {

// Outlines are numbered: footprints, dividers, bridges, and one number for all spokes.
class OutlineNumbers {
 public:
  explicit OutlineNumbers(const Floor& floor)
      : footprints_(static_cast<uint32_t>(floor.footprints.size())),
        first_bridge_(footprints_ + static_cast<uint32_t>(floor.dividers.size())),
        spokes_(first_bridge_ + static_cast<uint32_t>(floor.bridges.size())) {}

  [[nodiscard]] uint32_t first_bridge() const { return first_bridge_; }
  [[nodiscard]] bool Encloses(uint32_t outline) const { return outline < first_bridge_; }  // is a ring, no line
  [[nodiscard]] bool IsBridge(uint32_t outline) const { return outline >= first_bridge_ && outline < spokes_; }
  [[nodiscard]] bool IsDivider(uint32_t outline) const { return outline >= footprints_ && !IsBridge(outline); }  // or a spoke of one

 private:
  uint32_t footprints_, first_bridge_, spokes_;
};

// Those of footprints that bound rooms, of dividers, bridges and spokes; not snapped.
[[nodiscard]] SnapGraph OutlinesOf(const Floor& floor);

}  // namespace plumb::compiler
