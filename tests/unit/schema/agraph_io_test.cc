#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "schema/agraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"
#include "schema/files.h"
#include "tests/support/house.h"
#include "tests/support/temporary_folder.h"

namespace plumb {
namespace {

TEST(AGraphIo, ReadsBackWhatItWrote) {
  const AGraph house = test::MakeHouse();
  const std::vector<uint8_t> bytes = WriteAGraph(house);
  const Expected<AGraph> read = ReadAGraph(bytes);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(WriteAGraph(*read), bytes);
  EXPECT_EQ(AGraphToJson(*read), AGraphToJson(house));
  EXPECT_EQ(read->mesh.triangles.size(), house.mesh.triangles.size());
}

TEST(AGraphIo, KeepsArcsAliasesAndFactors) {
  AGraph house = test::MakeHouse();
  house.surfaces[0].arc = Arc{{1, 2}, 3, 0.5, -1.25};
  house.aliases.push_back({3.14, {1, 2, 0}, 0.9, StoreyId(0), StoreyId(0), {RoomId(0)}, {RoomId(1)}, 0.06, 12.5, true, {ElementId(2)}});
  house.look_alikes.push_back({{RoomId(0), RoomId(2)}});
  house.factors.push_back({FactorKind::kRoomSurfaces, {0, 0, 1, 2, 3}});
  house.true_north_rad = 0.0;
  house.open_boundaries.push_back({StoreyId(0), RoomId(1), RoomId(2), {1, 2}, {3, 4}});
  const Expected<AGraph> read = ReadAGraph(WriteAGraph(house));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(read->surfaces[0].arc.has_value());
  EXPECT_EQ(read->surfaces[0].arc->sweep_rad, -1.25);
  EXPECT_EQ(read->aliases[0].overlap_ratio, 0.9);
  EXPECT_EQ(read->aliases[0].twins, house.aliases[0].twins);
  EXPECT_EQ(read->aliases[0].section_length_m, 12.5);
  EXPECT_TRUE(read->aliases[0].closed);
  EXPECT_EQ(read->aliases[0].differences, house.aliases[0].differences);
  EXPECT_EQ(read->look_alikes[0].rooms, house.look_alikes[0].rooms);
  EXPECT_EQ(read->true_north_rad, 0.0);
  EXPECT_EQ(read->factors[0].variables.size(), 5u);
  ASSERT_EQ(read->open_boundaries.size(), 1u);
  EXPECT_EQ(read->open_boundaries[0].room_b, RoomId(2));
  EXPECT_EQ(read->open_boundaries[0].end, Eigen::Vector2d(3, 4));
}

TEST(AGraphIo, KeepsTheLeavesOfDoors) {
  AGraph house = test::MakeHouse();
  const std::vector<uint8_t> without = WriteAGraph(house);
  EXPECT_TRUE(ReadAGraph(without)->doorways[0].leaves.empty());
  house.doorways[0].leaves = {{LeafOperation::kSwing, Jamb::kLeft, DoorwaySide::kRoomB, 0.9}, {LeafOperation::kFixed, Jamb::kRight}};
  house.doorways[2].leaves = {{LeafOperation::kRevolving}};
  const Expected<AGraph> read = ReadAGraph(WriteAGraph(house));
  ASSERT_TRUE(read) << read.error().message;
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(read->doorways[i].leaves, house.doorways[i].leaves) << i;
}

TEST(AGraphIo, RefusesLeavesThatMoveInNoKnownWay) {
  AGraph house = test::MakeHouse();
  for (const DoorLeaf& wrong :
       {DoorLeaf{static_cast<LeafOperation>(8)}, DoorLeaf{.jamb = static_cast<Jamb>(3)}, DoorLeaf{.opens_to = static_cast<DoorwaySide>(3)},
        DoorLeaf{.width_m = -1}, DoorLeaf{.width_m = std::numeric_limits<double>::quiet_NaN()}}) {
    house.doorways[1].leaves = {wrong};
    EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  }
}

TEST(AGraphIo, RefusesADoorOfThreeLeaves) {
  AGraph house = test::MakeHouse();
  house.doorways[1].leaves.resize(3);
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
}

TEST(AGraphIo, RefusesAliasesOfRoomsThatAreNotThere) {
  AGraph house = test::MakeHouse();
  house.aliases.emplace_back();
  house.aliases[0].rooms = {RoomId(0)};
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  house.aliases[0].twins = {RoomId(99)};
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  house.aliases[0].twins = {RoomId(1)};
  EXPECT_TRUE(ReadAGraph(WriteAGraph(house)));
  house.look_alikes.push_back({{RoomId(7)}});
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
}

TEST(AGraphIo, RefusesOtherFiles) {
  const std::vector<uint8_t> jpeg = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0, 1};
  EXPECT_EQ(ReadAGraph(jpeg).error().code, ErrorCode::kNotAnAGraph);
  EXPECT_EQ(ReadAGraph({}).error().code, ErrorCode::kNotAnAGraph);
  EXPECT_EQ(ReadAGraphFile("/nonexistent.agraph").error().code, ErrorCode::kFileNotFound);
}

// A thousand options that share one string of a megabyte: a gigabyte from a megabyte.
TEST(AGraphIo, RefusesAFileThatUnfoldsToManyTimesItsSize) {
  AGraph house = test::MakeHouse();
  house.options.assign(1000, Option{"name", std::string(1 << 20, 'x')});
  const std::vector<uint8_t> bytes = WriteAGraph(house);
  EXPECT_LT(bytes.size(), size_t{2} << 20);
  EXPECT_EQ(ReadAGraph(bytes).error().code, ErrorCode::kAGraphDamaged);
  house.options.assign(50, Option{"name", std::string(1 << 20, 'x')});
  EXPECT_TRUE(ReadAGraph(WriteAGraph(house)));
}

TEST(AGraphIo, RefusesReferencesToNothing) {
  AGraph house = test::MakeHouse();
  house.surfaces[3].wall = WallId(99);
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  house = test::MakeHouse();
  house.mesh.triangles[5].c = 1u << 30;
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  house = test::MakeHouse();
  house.walls[0].thickness_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  house = test::MakeHouse();
  house.open_boundaries.push_back({StoreyId(0), RoomId(1), RoomId(77), {1, 2}, {3, 4}});
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
  house = test::MakeHouse();
  house.factors.push_back({FactorKind::kDoorwayRooms, {0, 77, 0}});
  EXPECT_EQ(ReadAGraph(WriteAGraph(house)).error().code, ErrorCode::kAGraphInconsistent);
}

TEST(AGraphIo, SurvivesEveryTruncation) {
  AGraph house = test::MakeHouse();
  house.mesh = {};
  const std::vector<uint8_t> bytes = WriteAGraph(house);
  for (size_t size = 0; size < bytes.size(); size += 7) {
    const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const Expected<AGraph> read = ReadAGraph(cut);
    // The last bytes may be padding.
    EXPECT_TRUE(!read || (bytes.size() - size < 8 && AGraphToJson(*read) == AGraphToJson(house))) << size;
  }
}

TEST(AGraphIo, SurvivesFlippedBits) {
  const std::vector<uint8_t> bytes = WriteAGraph(test::MakeHouse());
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    std::vector<uint8_t> damaged = bytes;
    for (int k = 0; k <= round % 3; ++k) damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1u << (random() % 8));
    EXPECT_TRUE(damaged == bytes || !ReadAGraph(damaged)) << round;
  }
}

// One checksum for all; written by version 1.1.
TEST(AGraphIo, ReadsFilesOfTheVersionBefore) {
  const std::string path = std::string(PLUMB_SOURCE_DIR) + "/tests/unit/schema/data/box_1_1.agraph";
  const Expected<AGraph> read = ReadAGraphFile(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rooms.size(), 1u);
  EXPECT_EQ(read->mesh.triangles.size(), 124u);
  std::vector<uint8_t> bytes = *ReadFileBytes(path);
  for (size_t at = 8; at < bytes.size(); at += 5) {
    bytes[at] ^= 4;
    EXPECT_FALSE(ReadAGraph(bytes)) << at;
    bytes[at] ^= 4;
  }
}

class OpenedFile : public ::testing::Test {
 protected:
  // The house with one byte changed.
  std::string Changed(size_t at) {
    std::vector<uint8_t> bytes = bytes_;
    bytes[at] ^= 16;
    EXPECT_TRUE(WriteFileAtomically(path_, bytes));
    return path_;
  }
  const test::TemporaryFolder folder_;
  const std::string path_ = folder_ / "house.agraph";
  const AGraph house_ = test::MakeHouse();
  const std::vector<uint8_t> bytes_ = WriteAGraph(house_);
  const size_t mesh_bytes_ = house_.mesh.vertices.size() * 12 + house_.mesh.triangles.size() * 16;
};

TEST_F(OpenedFile, GivesTheTrianglesWhenAsked) {
  ASSERT_TRUE(WriteAGraphFile(house_, path_));
  Expected<AGraphFile> file = AGraphFile::Open(path_);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(AGraphToJson(file->graph()), AGraphToJson(house_));
  EXPECT_TRUE(file->graph().mesh.triangles.empty());
  EXPECT_EQ(file->triangle_count(), house_.mesh.triangles.size());
  const Expected<AGraph> whole = std::move(*file).Load();
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(WriteAGraph(*whole), bytes_);
}

TEST_F(OpenedFile, OutlivesAnotherFileInItsPlace) {
  ASSERT_TRUE(WriteAGraphFile(house_, path_));
  Expected<AGraphFile> file = AGraphFile::Open(path_);
  ASSERT_TRUE(file);
  ASSERT_TRUE(WriteAGraphFile(AGraph(), path_));
  const Expected<AGraph> whole = std::move(*file).Load();
  ASSERT_TRUE(whole);
  EXPECT_EQ(WriteAGraph(*whole), bytes_);
}

// As a program that copies a file does that is stopped, or that starts anew.
TEST_F(OpenedFile, SaysThatItWasCutShortMeanwhile) {
  for (size_t left : {bytes_.size() - 1, bytes_.size() - mesh_bytes_, size_t{100}, size_t{0}}) {
    ASSERT_TRUE(WriteAGraphFile(house_, path_));
    Expected<AGraphFile> file = AGraphFile::Open(path_);
    ASSERT_TRUE(file);
    std::filesystem::resize_file(path_, left);
    const Expected<AGraph> whole = std::move(*file).Load();
    ASSERT_FALSE(whole) << left;
    EXPECT_EQ(whole.error().code, ErrorCode::kAGraphDamaged);
    EXPECT_NE(whole.error().message.find("cut short"), std::string::npos) << whole.error().message;
  }
}

TEST_F(OpenedFile, SaysThatTheTrianglesWereWrittenOverMeanwhile) {
  ASSERT_TRUE(WriteAGraphFile(house_, path_));
  Expected<AGraphFile> file = AGraphFile::Open(path_);
  ASSERT_TRUE(file);
  std::fstream(path_, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(static_cast<std::streamoff>(bytes_.size() - mesh_bytes_ / 2))
      .put('!');
  const Expected<AGraph> whole = std::move(*file).Load();
  ASSERT_FALSE(whole);
  EXPECT_EQ(whole.error().code, ErrorCode::kAGraphDamaged);
}

// The mesh is the last of the file: what is in front of it is refused at once, it itself when it is asked for.
TEST_F(OpenedFile, IsRefusedWhereItIsDamaged) {
  size_t late = 0;
  for (size_t at = 0; at < bytes_.size(); at += 3) {
    Expected<AGraphFile> file = AGraphFile::Open(Changed(at));
    if (!file) continue;
    EXPECT_GE(at, bytes_.size() - mesh_bytes_ - 16);
    const Expected<AGraph> whole = std::move(*file).Load();
    ASSERT_FALSE(whole) << at;
    EXPECT_EQ(whole.error().code, ErrorCode::kAGraphDamaged);
    EXPECT_NE(whole.error().message.find("house.agraph"), std::string::npos);
    ++late;
  }
  EXPECT_NEAR(static_cast<double>(late), static_cast<double>(mesh_bytes_) / 3, 2);
}

TEST(AGraphIo, WritesTheSameBytesTwice) { EXPECT_EQ(WriteAGraph(test::MakeHouse()), WriteAGraph(test::MakeHouse())); }

TEST(AGraphIo, LeavesNoTemporaryFileBehind) {
  const test::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  ASSERT_TRUE(WriteAGraphFile(test::MakeHouse(), folder / "house.agraph"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  EXPECT_TRUE(ReadAGraphFile(folder / "house.agraph"));
  EXPECT_EQ(WriteAGraphFile(test::MakeHouse(), folder / "no" / "such.agraph").error().code, ErrorCode::kFileUnwritable);
}

}  // namespace
}  // namespace plumb
