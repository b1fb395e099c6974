// Arrays with one value for each enumerator.
#include "core/base/enum_array.h"

#include <numeric>
#include <string>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

enum class Fruit { kApple, kPear, kPlum };
constexpr Fruit LastOf(Fruit) { return Fruit::kPlum; }

TEST(EnumArray, HasAPlaceForEachEnumeratorOfItsOwn) {
  EnumArray<Fruit, int> count{};
  EXPECT_EQ(std::accumulate(count.begin(), count.end(), 0), 0);
  int next = 1;
  for (const Fruit fruit : Enumerators<Fruit>()) count[fruit] = next++;
  EXPECT_EQ(count[Fruit::kApple], 1);
  EXPECT_EQ(count[Fruit::kPear], 2);
  EXPECT_EQ(count[Fruit::kPlum], 3);
  EXPECT_EQ(count.end() - count.begin(), 3);
}

TEST(EnumArray, TakesItsValuesInTheOrderOfTheEnumerators) {
  constexpr EnumArray<Fruit, const char*> kNames{{"apple", "pear", "plum"}};
  static_assert(kNames[Fruit::kPear][1] == 'e');
  EXPECT_EQ(std::string(kNames[Fruit::kPlum]), "plum");
}

TEST(EnumArray, IsEqualWhereAllValuesAre) {
  EnumArray<Fruit, double> a{{1.0, 2.0, 3.0}}, b = a;
  EXPECT_EQ(a, b);
  b[Fruit::kPlum] = 4.0;
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace patchmill
