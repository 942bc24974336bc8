#include "tools/plumb/flag_names.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace plumb::tools {
namespace {

constexpr auto kFlags = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"CompileOptions.section_height_m", "--section-height"},
    {"CompileOptions.snap_radius_m", "--snap-radius"},
    {"CompileOptions.max_gap_m", "--max-gap"},
    {"CompileOptions.min_room_area_m2", "--min-room-area"},
    {"MeshOptions.unit", "--unit"},
    {"MeshOptions.up", "--up"},
    {"MeshOptions.section_height_m", "--section-height"},
    {"DrawingFileOptions.unit", "--unit"},
    {"DrawingFileOptions.scale_m", "--scale"},
    {"DrawingFileOptions.sheet", "--sheet"},
    {"HeightOptions.storey_m", "--storey-height"},
    {"HeightOptions.door_m", "--door-height"},
    {"HeightOptions.sill_m", "--sill-height"},
    {"MassOptions.single_line_thickness_m", "--wall-thickness"},
    {"ReplayOptions.start_s", "--start"},
    {"ReplayOptions.max_duration_s", "--max-duration"},
    {"ReplayOptions.threads", "--threads"},
    {"ReplayOptions.rate", "--rate"},
    {"DeviationOptions.min_offset_m", "--tolerance"},
    {"DeviationOptions.false_discovery_rate", "--false-discovery-rate"},
    {"MatcherOptions.accept_probability", "--accept-probability"},
    {"StartHint.near_m", "--near"},
    {"StartHint.near_sigma_m", "--near X,Y,SIGMA with a SIGMA of"},
    {"SimulateOptions.deviate", "--deviate"},
    {"SimulateOptions.missing", "--missing"},
    {"SimulateOptions.unplanned", "--unplanned"},
    {"SimulateOptions.doorways", "--doorways"},
    {"SimulateOptions.sensor", "--sensor"},
    {"SimulateOptions.noise_m", "--noise"},
    {"SimulateOptions.speed_m_s", "--speed"},
    {"SimulateOptions.sensor_height_m", "--sensor-height"},
    {"SimulateOptions.min_duration_s", "--duration"},
    {"SimulateOptions.max_duration_s", "--max-duration"},
    {"SimulateOptions.glass_transmission", "--glass-transmission"},
    {"SimulateOptions.clutter", "--clutter"},
});
constexpr std::string_view kIs = " = ";

}  // namespace

std::string InFlags(const std::string& fault) {
  const size_t end = fault.find(kIs);
  const auto known =
      std::find_if(kFlags.begin(), kFlags.end(), [&](const auto& f) { return f.first == std::string_view(fault).substr(0, end); });
  if (end == std::string::npos || known == kFlags.end()) return fault;
  return std::string(known->second) + " " + fault.substr(end + kIs.size());
}

}  // namespace plumb::tools
