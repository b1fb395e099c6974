#include "server/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

StoreKey Model(const std::string& digest, const std::string& caller = "") {
  return {Stored::kModel, caller, digest};
}

std::shared_ptr<const std::string> Text(const char* text) {
  return std::make_shared<const std::string>(text);
}

TEST(Store, FindsWhatWasPutForThisCallerAlone) {
  Store store(1 << 20);
  store.Put<std::string>(Model("a", "ann"), Text("of ann"), 100);
  ASSERT_NE(store.Find<std::string>(Model("a", "ann")), nullptr);
  EXPECT_EQ(*store.Find<std::string>(Model("a", "ann")), "of ann");
  EXPECT_EQ(store.Find<std::string>(Model("a", "bob")), nullptr);
  EXPECT_EQ(store.Find<std::string>(Model("a")), nullptr);
  EXPECT_EQ(store.Find<std::string>({Stored::kAnswer, "ann", "a"}), nullptr);
  EXPECT_EQ(store.Find<int>(Model("a", "ann")), nullptr);  // another type is no value
}

TEST(Store, ForgetsWhatWasUsedLongestAgo) {
  Store store(40'000);
  for (const char* key : {"a", "b", "c"}) store.Put<std::string>(Model(key), Text(key), 9'000);
  EXPECT_NE(store.Find<std::string>(Model("a")), nullptr);  // used now
  store.Put<std::string>(Model("d"), Text("d"), 9'000);
  store.Put<std::string>(Model("e"), Text("e"), 9'000);
  EXPECT_NE(store.Find<std::string>(Model("a")), nullptr);
  EXPECT_EQ(store.Find<std::string>(Model("b")), nullptr);
  EXPECT_NE(store.Find<std::string>(Model("c")), nullptr);
  EXPECT_NE(store.Find<std::string>(Model("e")), nullptr);
  EXPECT_LE(store.figures().bytes, 40'000u);
  EXPECT_EQ(store.figures().forgotten, 1u);
}

TEST(Store, AnAnswerAboveAQuarterIsNotKeptAndItsOldOneIsGone) {
  Store store(40'000);
  const StoreKey key{Stored::kAnswer, "", "a"};
  EXPECT_TRUE(store.Put<std::string>(key, Text("small"), 1'000));
  EXPECT_FALSE(store.Put<std::string>(key, Text("large"), 20'000));
  EXPECT_EQ(store.Find<std::string>(key), nullptr);
  EXPECT_EQ(store.figures().bytes, 0u);
}

TEST(Store, AModelMayTakeAllOfIt) {
  Store store(40'000);
  EXPECT_TRUE(store.Put<std::string>(Model("a"), Text("a"), 30'000));
  EXPECT_TRUE(store.Put<std::string>(Model("b"), Text("b"), 30'000));
  EXPECT_EQ(store.Find<std::string>(Model("a")), nullptr);
  EXPECT_FALSE(store.Put<std::string>(Model("c"), Text("c"), 40'001));
  EXPECT_NE(store.Find<std::string>(Model("b")), nullptr);
}

TEST(Store, ANewValueReplacesTheOldOne) {
  Store store(40'000);
  store.Put<std::string>(Model("a"), Text("one"), 1'000);
  store.Put<std::string>(Model("a"), Text("two"), 2'000);
  EXPECT_EQ(*store.Find<std::string>(Model("a")), "two");
  EXPECT_EQ(store.figures().values, 1u);
}

TEST(Store, AForgottenModelTakesItsAnswersAlong) {
  Store store(1 << 20);
  store.Put<std::string>(Model("m", "ann"), Text("model"), 10);
  store.Put<std::string>({Stored::kAnswer, "ann", "1"}, Text("of m"), 10, "m");
  store.Put<std::string>({Stored::kAnswer, "ann", "2"}, Text("of another"), 10, "n");
  store.Put<std::string>({Stored::kAnswer, "bob", "3"}, Text("of bob"), 10, "m");
  EXPECT_FALSE(store.ForgetModel("bob", "m"));
  EXPECT_TRUE(store.ForgetModel("ann", "m"));
  EXPECT_FALSE(store.ForgetModel("ann", "m"));
  EXPECT_EQ(store.Find<std::string>({Stored::kAnswer, "ann", "1"}), nullptr);
  EXPECT_NE(store.Find<std::string>({Stored::kAnswer, "ann", "2"}), nullptr);
}

TEST(Store, OfNoSizeKeepsNothing) {
  Store store(0);
  store.Put<std::string>(Model("a"), Text("x"), 1);
  EXPECT_EQ(store.Find<std::string>(Model("a")), nullptr);
}

}  // namespace
}  // namespace patchmill
