// SPDX-License-Identifier: Apache-2.0
// Worker threads, the resolution while moving, the copied command line: what the window stands on, without
// one.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "viewer/command_text.h"
#include "viewer/resolution.h"
#include "viewer/worker.h"

namespace catoptric::viewer {
namespace {

using IntWorker = Worker<int, int>;

template <class Condition>
bool waitUntil(const Condition& condition) {
  for (int i = 0; i < 5000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

TEST(Worker, DropsWhatWasOvertakenAndWorksOnOneThread) {
  std::atomic<bool> mayGo = false;
  std::atomic<int> calls = 0;
  std::atomic<bool> sameThread = true;
  IntWorker worker(
      [&]() -> IntWorker::Work {
        const auto home = std::this_thread::get_id();
        return [&, home](const int& request) {
          if (std::this_thread::get_id() != home) sameThread = false;
          ++calls;
          while (!mayGo) std::this_thread::yield();
          return 2 * request;
        };
      },
      [] {});
  worker.ask(1);
  ASSERT_TRUE(waitUntil([&] { return calls == 1; }));
  worker.ask(2);
  worker.ask(3);
  EXPECT_TRUE(worker.isBusy());
  mayGo = true;
  ASSERT_TRUE(waitUntil([&] { return !worker.isBusy(); }));
  EXPECT_EQ(worker.take(), 6);
  EXPECT_EQ(worker.take(), std::nullopt);
  EXPECT_EQ(calls, 2);
  EXPECT_TRUE(sameThread);
}

TEST(Worker, FailuresAreToldOnceAndEndNothing) {
  std::atomic<int> wakes = 0;
  IntWorker worker(
      []() -> IntWorker::Work {
        return [](const int& request) {
          if (request < 0) throw std::runtime_error("negative");
          return request;
        };
      },
      [&] { ++wakes; });
  worker.ask(-1);
  ASSERT_TRUE(waitUntil([&] { return wakes == 1; }));
  EXPECT_THROW((void)worker.take(), std::runtime_error);
  EXPECT_EQ(worker.take(), std::nullopt);
  worker.ask(5);
  ASSERT_TRUE(waitUntil([&] { return wakes == 2; }));
  EXPECT_EQ(worker.take(), 5);
}

/// Drawing takes `fullMs` for all pixels and `fixedMs` for any number of them.
double settle(MovingResolution& moving, double fullMs, double fixedMs) {
  for (int i = 0; i < 20; ++i)
    moving.learn(moving.scale(), fixedMs + fullMs * moving.scale() * moving.scale());
  return moving.scale();
}

TEST(MovingResolution, FindsAScaleThatIsFastEnoughAndStaysThere) {
  for (const double fullMs : {5.0, 60.0, 100.0, 200.0, 400.0}) {
    MovingResolution moving;
    const double scale = settle(moving, fullMs, 2);
    EXPECT_LE(2 + fullMs * scale * scale, MovingResolution::kTooSlowMs) << fullMs;
    EXPECT_EQ(settle(moving, fullMs, 2), scale) << fullMs;
  }
}

TEST(MovingResolution, RecoversWhenFramesAreFastAgain) {
  MovingResolution moving;
  EXPECT_LT(settle(moving, 2000, 0), 0.3);
  EXPECT_EQ(settle(moving, 20, 0), 1.0);
  moving.learn(0.25, 5000);  // a late result of another size says nothing
  EXPECT_EQ(moving.scale(), 1.0);
}

TEST(CommandText, NamesWhatDiffersFromTheDefaults) {
  LoadRequest request;
  request.source = "my scene.glb";
  request.mirrors = {"Mirror#1"};
  scene::Camera camera;
  camera.eye = dvec3(-1, 0.1, 1e-7);
  renderer::FrameOptions options;
  options.bounces = 3;
  EXPECT_EQ(makeCommandText(request, camera, options, 1.5f, {"--scene=2"}),
            "catoptric render 'my scene.glb' -o picture.png --scene=2 --reflector='Mirror#1' --method=auto "
            "--size=960x720 --bounces=3 --exposure=1.5 --eye=-1,0.1,1e-07 --target=0,0,-1 --up=0,1,0 "
            "--fov=51.56620156177409");
}

TEST(CommandText, QuotesAsAShellReads) {
  EXPECT_EQ(quoteForShell("a/b-c_1.glb"), "a/b-c_1.glb");
  EXPECT_EQ(quoteForShell(""), "''");
  EXPECT_EQ(quoteForShell("it's $x"), "'it'\\''s $x'");
}

}  // namespace
}  // namespace catoptric::viewer
