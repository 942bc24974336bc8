// DXF drawings in text form, built entity by entity.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace plumb::test {

using DxfPairs = std::vector<std::pair<int, std::string>>;

class DxfText {
 public:
  DxfText& Header(const std::string& name, int code, const std::string& value) {
    header_ += fmt::format("  9\n{}\n{:>3}\n{}\n", name, code, value);
    return *this;
  }
  DxfText& Entity(const std::string& type, const std::string& layer, const DxfPairs& pairs) {
    std::string& out = block_.empty() ? entities_ : blocks_;
    out += fmt::format("  0\n{}\n  5\n{:X}\n  8\n{}\n", type, ++handle_, layer);
    for (const auto& [code, value] : pairs) out += fmt::format("{:>3}\n{}\n", code, value);
    return *this;
  }
  DxfText& Line(const std::string& layer, double x0, double y0, double x1, double y1) {
    return Entity("LINE", layer,
                  {{10, fmt::format("{}", x0)}, {20, fmt::format("{}", y0)}, {11, fmt::format("{}", x1)}, {21, fmt::format("{}", y1)}});
  }
  // A closed outline.
  DxfText& Outline(const std::string& layer, const std::vector<std::pair<double, double>>& points) {
    DxfPairs pairs = {{90, fmt::format("{}", points.size())}, {70, "1"}};
    for (const auto& [x, y] : points) pairs.insert(pairs.end(), {{10, fmt::format("{}", x)}, {20, fmt::format("{}", y)}});
    return Entity("LWPOLYLINE", layer, pairs);
  }
  DxfText& Box(const std::string& layer, double x0, double y0, double x1, double y1) {
    return Outline(layer, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
  }
  DxfText& Text(const std::string& layer, const std::string& text, double x, double y, double height = 0.2) {
    return Entity("TEXT", layer, {{10, fmt::format("{}", x)}, {20, fmt::format("{}", y)}, {40, fmt::format("{}", height)}, {1, text}});
  }
  DxfText& Insert(const std::string& layer, const std::string& block, double x, double y, const DxfPairs& more = {}) {
    DxfPairs pairs = {{2, block}, {10, fmt::format("{}", x)}, {20, fmt::format("{}", y)}};
    pairs.insert(pairs.end(), more.begin(), more.end());
    return Entity("INSERT", layer, pairs);
  }
  DxfText& Begin(const std::string& block) {
    block_ = block;
    blocks_ += fmt::format("  0\nBLOCK\n  8\n0\n  2\n{}\n 70\n0\n 10\n0\n 20\n0\n", block);
    return *this;
  }
  DxfText& End() {
    blocks_ += "  0\nENDBLK\n";
    block_.clear();
    return *this;
  }
  // A door 1 wide: its hinge in the origin, closed along +x.
  DxfText& DoorBlock(const std::string& name) {
    Begin(name).Line("0", 0, 0, 0, 1);
    Entity("ARC", "0", {{10, "0"}, {20, "0"}, {40, "1"}, {50, "0"}, {51, "90"}});
    return End();
  }
  [[nodiscard]] std::string Str() const {
    const auto section = [](const char* name, const std::string& body) {
      return fmt::format("  0\nSECTION\n  2\n{}\n{}  0\nENDSEC\n", name, body);
    };
    return section("HEADER", header_) + section("BLOCKS", blocks_) + section("ENTITIES", entities_) + "  0\nEOF\n";
  }

 private:
  std::string header_, blocks_, entities_, block_;
  int handle_ = 0x20;
};

}  // namespace plumb::test
