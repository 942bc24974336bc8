#include "compiler/frontends/drawing/room_names.h"

#include <gtest/gtest.h>

namespace plumb::compiler {
namespace {

DrawnText At(double y, const std::string& text, double height = 0.2) {
  DrawnText out;
  out.text = text;
  out.at = {0, y};
  out.height_m = height;
  return out;
}

std::string NameOf(const std::vector<DrawnText>& texts) {
  std::vector<const DrawnText*> pointers;
  for (const DrawnText& t : texts) pointers.push_back(&t);
  return RoomName(pointers);
}

TEST(RoomNames, NumberAndNameAreJoinedFromTopToBottom) { EXPECT_EQ(NameOf({At(1, "Office"), At(2, "101")}), "101 Office"); }

TEST(RoomNames, MeasuresAreNoNames) {
  EXPECT_EQ(NameOf({At(3, "Kitchen"), At(2, "3.25 x 4.10"), At(1, "13.3 m2"), At(0, "12'-6\"")}), "Kitchen");
  for (const char* measure : {"+0.00", "BRH 0.90", "H = 2.50 m", "14.3 m\u00b2", "F: 12,40 m2", "3 m", "OKFF +3.20", "24 x 36"})
    EXPECT_EQ(NameOf({At(2, measure)}), "") << measure;
}

TEST(RoomNames, ShortNamesWithNumbersAreNames) {
  for (const char* name : {"WC", "G.5 WC", "U.3 Bad", "WC 1", "B 12", "B-12", "R0-3", "101 A", "EDV"})
    EXPECT_EQ(NameOf({At(2, name)}), name) << name;
}

TEST(RoomNames, NotesOnTheDrawingAreNoNames) {
  for (const char* note : {"Scale 1:100",
                           "SCALE 1 : 50",
                           "M 1:100",
                           "Ma\u00dfstab 1:50",
                           "ECHELLE 1/100",
                           "1:200",
                           "NTS",
                           "Date: 12.03.2019",
                           "2019-03-12",
                           "Stand 01.02.2020",
                           "Drawn by: JM",
                           "Project: Hall",
                           "Sheet 3",
                           "Blatt 2",
                           "Rev. B",
                           "Section A-A",
                           "Schnitt B-B",
                           "Plan Nr. 5",
                           "Scale 1/8\" = 1'-0\"",
                           "\u00c9CHELLE 1:33",
                           "M 1:2000",
                           "Ground floor plan",
                           "GRUNDRISS EG",
                           "FLOOR PLAN",
                           "Floor plan level 2",
                           "2nd floor plan",
                           "Grundriss",
                           "Grundriss 1. Obergescho\u00df",
                           "PLAN DU REZ-DE-CHAUSS\u00c9E",
                           "Plan de l'\u00e9tage 1",
                           "Pianta piano terra",
                           "Proposed first floor plan",
                           "+3.50",
                           "\u00b1 0.00",
                           "-0,15",
                           "N"})
    EXPECT_EQ(NameOf({At(2, note)}), "") << note;
  EXPECT_EQ(NameOf({At(3, "Lounge"), At(2, "Scale 1:100", 0.5)}), "Lounge");
}

TEST(RoomNames, RoomsMayBeCalledByTheWordsOfNotes) {
  for (const char* name : {"Drawing office",
                           "3 Drawing office",
                           "Project room",
                           "Projektraum",
                           "Scala",
                           "Plan room",
                           "Section",
                           "Room: 101",
                           "Standby",
                           "Sheet store",
                           "Data room",
                           "Raum 1-12",
                           "Office 1/12",
                           "Flat 1/24",
                           "Flat 1/100",
                           "Room 1:12",
                           "Floor plan archive",
                           "Plan de travail",
                           "Grundrissarchiv",
                           "Pianta",
                           "First floor lounge",
                           "Scala 1"})
    EXPECT_EQ(NameOf({At(2, name)}), name) << name;
  std::vector<DrawnText> stated = {At(2, "N")};
  stated[0].names_room = true;
  EXPECT_EQ(NameOf(stated), "N");
}

TEST(RoomNames, SizesOfDoorsAreNoNames) { EXPECT_EQ(NameOf({At(3, "BATH"), At(2, "2668"), At(1, "2468")}), "BATH"); }

TEST(RoomNames, StatedAndUnderlinedNamesGoFirst) {
  std::vector<DrawnText> texts = {At(3, "STUDS @ OC"), At(2, "GARAGE")};
  texts[1].underlined = true;
  EXPECT_EQ(NameOf(texts), "GARAGE");
  texts[0].names_room = true;
  EXPECT_EQ(NameOf(texts), "STUDS @ OC");
}

TEST(RoomNames, SmallPrintIsLeftOut) { EXPECT_EQ(NameOf({At(2, "Store", 0.3), At(1, "shelves", 0.1)}), "Store"); }

}  // namespace
}  // namespace plumb::compiler
