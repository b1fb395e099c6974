// Open edges that run along each other in part, or with a gap.
#include "core/network/edge_contacts.h"

#include <gtest/gtest.h>

#include "core/base/status.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

PatchNetwork NetworkOf(const PatchModel& model) {
  auto network = BuildNetwork(model);
  PM_CHECK(network.ok());
  return *std::move(network);
}
std::vector<EdgeContact> ContactsOf(const PatchModel& model) {
  return FindEdgeContacts(model, NetworkOf(model), RunContext());
}

// Edge 2 (v = 1) of the level runs along +x at y = 10. The wall's lower edge is edge 0, or 3 when turned.
TEST(EdgeContacts, OverlapInPart) {
  for (const bool turned : {false, true}) {
    for (const bool back : {false, true}) {
      const Vec2 a(-25, 10), b(15, 10);
      const auto contacts =
          ContactsOf(Join({Level(-20, 0, 20, 10, 0), Wall(back ? b : a, back ? a : b, 0, 8, turned)}));
      ASSERT_EQ(contacts.size(), 2U) << turned << back;
      EXPECT_EQ(contacts[0].self, (PatchEdge{PatchId(0), 2}));
      EXPECT_EQ(contacts[0].other, (PatchEdge{PatchId(1), turned ? 3 : 0}));
      EXPECT_EQ(contacts[1].self, contacts[0].other);
      EXPECT_EQ(contacts[1].other, contacts[0].self);
      for (const EdgeContact& contact : contacts) EXPECT_EQ(contact.reversed, back);
    }
  }
}

TEST(EdgeContacts, AGapOfUpToTenJoinTolerances) {
  const double tolerance = NetworkOf(Level(-20, 0, 20, 10, 0)).join_tolerance;
  for (const double gap : {2.0, 9.0, 11.0, 100.0}) {
    const double y = 10.0 + gap * tolerance;
    const bool found = !ContactsOf(Join({Level(-20, 0, 20, 10, 0), Wall({-20, y}, {20, y}, 0, 8)})).empty();
    EXPECT_EQ(found, gap < 10.0) << gap;
  }
}

// Joined edges, edges that only cross, and edges of one patch are none.
TEST(EdgeContacts, NoneElsewhere) {
  EXPECT_TRUE(ContactsOf(OpenBox(20, 15, 12)).empty());
  EXPECT_TRUE(ContactsOf(Join({Level(-20, 0, 20, 10, 0), Wall({0, 5}, {0, 15}, 0, 8)})).empty());
  EXPECT_TRUE(ContactsOf(Level(0, 0, 1e-3, 10, 0)).empty());
}

}  // namespace
}  // namespace patchmill
