// Options of the mesh frontend, which the frontend of Gazebo worlds shares.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace plumb::compiler {

struct MeshOptions {
  std::string unit;                              // m, cm, mm, in or ft; empty: as stated by the file or seen in its walls
  std::string up;                                // x, y or z; empty: as stated by the file or seen in its walls
  double section_height_m = 1.1;                 // rooms are closed by whatever stands as high; parapets are raised above it
  double min_wall_thickness_m = 0.01;            // faces closer than this are one sheet
  double max_wall_thickness_m = 0.65;            // faces farther apart than this are no wall
  double sheet_thickness_m = 0.1;                // of walls that have one face only
  double max_free_gap_m = 4.0;                   // between two ends in one line with nothing above or below
  double max_door_gap_m = 1.25;                  // between the end of a wall and the flank of another
  double min_parapet_height_m = 0.8;             // lower walls bound no room
  double line_tolerance_m = 0.004;               // faces this close in one direction lie in one plane
  double reader_time_s = 20;                     // that reading a mesh may take
  size_t reader_memory_bytes = size_t{2} << 30;  // of address space
  size_t max_triangles = 1500000;                // of all objects
  std::vector<std::string> model_path;           // folders besides the world's own in which included models are looked for
  // Empty if every field is valid; else names the field, its value and the rule.
  [[nodiscard]] std::string Check() const;
};

}  // namespace plumb::compiler
