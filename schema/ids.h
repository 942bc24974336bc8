// Typed ids: positions in the A-Graph's tables. An id of one table does not compile where another is asked for.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace plumb {

template <class Tag>
struct Id {
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(uint32_t v) : value(v) {}
  constexpr explicit Id(size_t v) : value(static_cast<uint32_t>(v)) {}
  constexpr explicit Id(int v) : value(static_cast<uint32_t>(v)) {}

  [[nodiscard]] constexpr bool valid() const { return value != kNone; }
  [[nodiscard]] constexpr size_t index() const { return value; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using StoreyId = Id<struct StoreyTag>;
using WallId = Id<struct WallTag>;
using SurfaceId = Id<struct SurfaceTag>;
using RoomId = Id<struct RoomTag>;
using DoorwayId = Id<struct DoorwayTag>;
using WindowId = Id<struct WindowTag>;
using ElementId = Id<struct ElementTag>;

}  // namespace plumb

template <class Tag>
struct std::hash<plumb::Id<Tag>> {
  size_t operator()(plumb::Id<Tag> id) const noexcept { return std::hash<uint32_t>{}(id.value); }
};
