#include "runtime/localizer/bounded_queue.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace plumb::runtime {
namespace {

TEST(BoundedQueue, GivesItemsInTheirOrder) {
  BoundedQueue<int> queue(3);
  EXPECT_TRUE(queue.Push(1) && queue.Push(2) && queue.Push(3));
  EXPECT_EQ(queue.size(), 3u);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(queue.Pop(), i);
  EXPECT_EQ(queue.size(), 0u);
}

TEST(BoundedQueue, LeavesAnItemAloneThatItCannotTake) {
  BoundedQueue<std::unique_ptr<int>> queue(1);
  auto first = std::make_unique<int>(1), second = std::make_unique<int>(2);
  EXPECT_TRUE(queue.TryPush(first));
  EXPECT_FALSE(queue.TryPush(second));
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(**queue.Pop(), 1);
  EXPECT_TRUE(queue.TryPush(second));
  EXPECT_EQ(second, nullptr);
}

TEST(BoundedQueue, HandsOutWhatItHoldsWhenClosedAndTakesNoMore) {
  BoundedQueue<int> queue(4);
  int refused = 2;
  queue.Push(1);
  queue.Close();
  EXPECT_FALSE(queue.Push(2));
  EXPECT_FALSE(queue.TryPush(refused));
  EXPECT_EQ(queue.Pop(), 1);
  EXPECT_EQ(queue.Pop(), std::nullopt);
}

TEST(BoundedQueue, NeverHoldsMoreThanItsCapacityAndLosesNothingBetweenThreads) {
  constexpr int kCount = 20000;
  BoundedQueue<int> queue(3);
  std::thread producer([&] {
    for (int i = 0; i < kCount; ++i) ASSERT_TRUE(queue.Push(i));
    queue.Close();
  });
  int expected = 0;
  while (const std::optional<int> item = queue.Pop()) {
    ASSERT_EQ(*item, expected++);
    ASSERT_LE(queue.size(), 3u);
  }
  producer.join();
  EXPECT_EQ(expected, kCount);
}

TEST(BoundedQueue, ClosingWakesWhoeverWaits) {
  BoundedQueue<int> full(1), empty(1);
  full.Push(1);
  bool taken = true;
  std::optional<int> got = 1;
  std::thread producer([&] { taken = full.Push(2); });
  std::thread consumer([&] { got = empty.Pop(); });
  full.Close();
  empty.Close();
  producer.join();
  consumer.join();
  EXPECT_FALSE(taken);
  EXPECT_EQ(got, std::nullopt);
}

}  // namespace
}  // namespace plumb::runtime
