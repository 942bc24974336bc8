// The A-Graph in memory: what a plan says about storeys, walls, wall surfaces, rooms and doorways.
//
// It is the only thing that the compiler and the runtime share: the compiler fills one and writes it (agraph_writer.h),
// the runtime reads one (agraph_reader.h). Plain data; ids are positions in the vectors.
//
// Frame: `plan`, the plan's own coordinates in metres, z up. Angles in radians, counter-clockwise about +z.
// Only `Mesh::vertices` are offsets from `AGraph::origin` (single precision holds them even far from the plan's zero).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schema/ids.h"

namespace plumb {

inline constexpr uint32_t kSchemaMajor = 2;
inline constexpr uint32_t kSchemaMinor = 1;

// As in agraph.fbs, same order.
enum class ElementKind : uint8_t {
  kOther,
  kWall,
  kCurtainWall,
  kSlab,
  kRoof,
  kColumn,
  kBeam,
  kStair,
  kRailing,
  kDoor,
  kWindow,
  kFurniture,
  kCovering,
  kProxy,
  kGround
};
enum class Material : uint8_t { kOpaque, kGlass };
enum class FactorKind : uint8_t { kWallSurfaces, kRoomSurfaces, kDoorwayRooms, kStoreyRoom };
enum class Severity : uint8_t { kNote, kRemark, kWarning, kError };

struct Storey {
  std::string guid, name;
  double elevation_m = 0;  // z of the storey's zero in the plan frame
  double height_m = 0;     // to the next storey, or to the highest ceiling on the last one
};

struct Wall {
  std::string guid, name, type;  // GlobalId or handle; name; the source's own type, e.g. IfcWallStandardCase
  StoreyId storey;
  Eigen::Vector2d axis_start = Eigen::Vector2d::Zero(), axis_end = Eigen::Vector2d::Zero();  // centre line
  double thickness_m = 0, z_min_m = 0, z_max_m = 0;
  bool external = false;  // one side faces no room
};

// An arc of a curved surface; points are center + radius * (cos a, sin a), a from start to start + sweep.
struct Arc {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius_m = 0, start_rad = 0, sweep_rad = 0;
};

// One side of a wall as far as it bounds one room (or the outside). The plane is n . x + d = 0 with n into the free space.
// Seen from the free space, `start` is on the right and `end` on the left: n = rot90ccw(end - start) normalized.
struct Surface {
  WallId wall;
  StoreyId storey;
  RoomId room;  // none: exterior
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double d_m = 0;
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();
  double z_min_m = 0, z_max_m = 0;
  std::optional<Arc> arc;  // set for a curved surface; normal and d_m are then those of the chord

  [[nodiscard]] Eigen::Vector2d midpoint() const { return 0.5 * (start + end); }
  [[nodiscard]] double length_m() const { return (end - start).norm(); }
};

using Ring = std::vector<Eigen::Vector2d>;  // not closed: the last point is not the first again

struct Room {
  std::string guid, name;  // of the source's space (IfcSpace) where one matches, else empty guid and a made name
  StoreyId storey;
  Ring polygon;             // outer boundary, counter-clockwise
  std::vector<Ring> holes;  // clockwise
  double area_m2 = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // pose: area centroid at floor height ...
  double yaw_rad = 0;                                // ... and the direction of the longest side, in [0, pi/2)
  double floor_z_m = 0, ceiling_z_m = 0;
  std::vector<SurfaceId> surfaces;  // in the order of the outer boundary, then of the holes
};

// How a door's leaf moves. kDoubleActing: swings to both sides; kLifting: rolls or swings up; kFixed: does not move.
enum class LeafOperation : uint8_t { kUnknown, kSwing, kDoubleActing, kSliding, kFolding, kRevolving, kLifting, kFixed };
// Of a doorway, as seen by someone who passes from room_a to room_b: kLeft is the one that lies along (-sin yaw, cos yaw) from its middle.
enum class Jamb : uint8_t { kUnknown, kLeft, kRight };
enum class DoorwaySide : uint8_t { kUnknown, kRoomA, kRoomB };

// One leaf of a door in the doorway's own terms, so that no motion of the plan changes it. What the source does not tell is unknown.
struct DoorLeaf {
  LeafOperation operation = LeafOperation::kUnknown;
  Jamb jamb = Jamb::kUnknown;  // where it hangs; of a sliding leaf the one that it opens towards; of a fixed one the nearer
  DoorwaySide opens_to = DoorwaySide::kUnknown;  // of a swinging, folding or lifting leaf
  double width_m = 0;                            // 0: unknown
  friend bool operator==(const DoorLeaf&, const DoorLeaf&) = default;
};

struct Doorway {
  std::string guid, name;
  StoreyId storey;
  WallId wall;
  RoomId room_a, room_b;                               // none: outside
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // middle of the opening on the wall's centre line, at the sill
  double yaw_rad = 0;                                  // direction of the passage: from room_a to room_b
  double width_m = 0, height_m = 0;
  bool has_leaf = true;          // false: an opening without a door
  std::vector<DoorLeaf> leaves;  // one or two, the left one first where both are known; empty: unknown, or none (has_leaf)
};

struct Window {
  std::string guid, name;
  StoreyId storey;
  WallId wall;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // middle of the opening on the wall's centre line, at the sill
  double yaw_rad = 0;                                  // direction along the wall's normal
  double width_m = 0, height_m = 0;
};

struct Column {
  std::string guid, name;
  StoreyId storey;
  Ring outline;
  double z_min_m = 0, z_max_m = 0;
};

// Where two rooms meet without a wall between them: parts of an open plan that the source names apart.
struct OpenBoundary {
  StoreyId storey;
  RoomId room_a, room_b;
  Eigen::Vector2d start = Eigen::Vector2d::Zero(), end = Eigen::Vector2d::Zero();  // room_a on the left of the way from start to end
};

// What ties the nodes. Variables by kind: kWallSurfaces: wall, surface, surface (opposite faces);
// kRoomSurfaces: room, surfaces...; kDoorwayRooms: doorway, room, room; kStoreyRoom: storey, room.
struct Factor {
  FactorKind kind = FactorKind::kWallSurfaces;
  std::vector<uint32_t> variables;
};

// A thing in the building that a ray can hit.
struct Element {
  std::string guid, name, type;
  ElementKind kind = ElementKind::kOther;
  Material material = Material::kOpaque;
  StoreyId storey;
  WallId wall;        // the wall it is, or the wall that hosts it (doors, windows)
  DoorwayId doorway;  // for the leaf and frame of a door
};

struct Triangle {
  uint32_t a = 0, b = 0, c = 0;  // vertices, counter-clockwise seen from outside the solid
  uint32_t element = 0;
};

struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  // plan frame minus AGraph::origin, metres
  std::vector<Triangle> triangles;
};

// A rigid motion x -> Rz(yaw) x + translation under which rooms of the plan fall on rooms that a LiDAR cannot tell from them. It goes both
// ways: a robot in `twins` may as well be in `rooms`.
struct Alias {
  double yaw_rad = 0;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double overlap_ratio = 0;            // share of the rooms' wall sections that coincide with those of their twins
  StoreyId from_storey, to_storey;     // of the rooms and of their twins; none: several
  std::vector<RoomId> rooms, twins;    // rooms[i] falls on twins[i]
  double tolerance_m = 0;              // within which sections coincide
  double section_length_m = 0;         // of the rooms' wall sections, mean of the heights looked at
  bool closed = false;                 // no doorway leads from the rooms, or from their twins, to a room that is none of them
  std::vector<ElementId> differences;  // what has no counterpart, longest first
};

// Rooms of one shape that a LiDAR cannot tell apart from inside: doorways, walls and other fixed things stand alike.
struct LookAlikes {
  std::vector<RoomId> rooms;
};

struct DiagnosticCount {
  std::string code;
  Severity severity = Severity::kWarning;
  uint32_t count = 0;
};

struct Option {
  std::string name, value;
};

struct AGraph {
  std::string tool_version, source_path, source_format, source_sha256;
  std::vector<Option> options;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::optional<double> true_north_rad;  // direction of true north in the plan frame, counter-clockwise from +x; none: not known

  std::vector<Storey> storeys;
  std::vector<Wall> walls;
  std::vector<Surface> surfaces;
  std::vector<Room> rooms;
  std::vector<Doorway> doorways;
  std::vector<Window> windows;
  std::vector<Column> columns;
  std::vector<OpenBoundary> open_boundaries;
  std::vector<Factor> factors;
  std::vector<Element> elements;
  Mesh mesh;
  std::vector<Alias> aliases;
  std::vector<LookAlikes> look_alikes;
  std::vector<DiagnosticCount> diagnostics;
};

}  // namespace plumb
