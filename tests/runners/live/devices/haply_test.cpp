// The adapter of Haply's Inverse3 against a simulated service (tests/doubles/haply_service.h): what it reads
// and writes, and how fast.
#include "runners/live/devices/haply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "runners/live/timing/steady_clock.h"
#include "tests/doubles/haply_service.h"
#include "tests/runners/live/devices/haply_ticks.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/test_files.h"

namespace remote_touch::haply_test {
namespace {

TEST(Haply, AxesAndUnits) {
  HaplyWorld world;
  HaplyService service(world);
  const auto device = open_haply(service.address());
  EXPECT_EQ(device->traits().name, "Haply Inverse3 049D");
  EXPECT_EQ(device->traits().actuated_axes, 3);
  for (const auto& command : service.commands())
    EXPECT_TRUE(command.force_N.isZero()) << "before the first write";

  world.position_m = Vec3(0.1, 0.2, 0.3);  // to the right, away from the user, up
  world.velocity_m_per_s = Vec3(1, 2, 3);
  service.set(world);
  DeviceReading reading;
  ASSERT_EQ(reading_fault(*device, reading), "");
  EXPECT_TRUE(reading.position_m.isApprox(Vec3(0.1, 0.3, -0.2), 1e-12));
  EXPECT_TRUE(reading.velocity_m_per_s.isApprox(Vec3(1, 3, -2), 1e-12));

  ASSERT_EQ(tick_fault(*device, reading, {1, 2, 3}), "");  // to the right, up, towards the user
  ASSERT_EQ(reading_fault(*device, reading), "");
  const auto commands = service.commands();
  const auto sent = std::find_if(commands.begin(), commands.end(), [](const HaplyService::Command& command) {
    return !command.force_N.isZero();
  });
  ASSERT_NE(sent, commands.end());
  EXPECT_EQ(sent->force_N, Vec3(1, -3, 2));
  EXPECT_EQ(sent->key, "vector");
  EXPECT_EQ(sent->device_id, "049D");
}

TEST(Haply, OrientationAndButtonsOfTheHandle) {
  HaplyWorld world;
  world.a = world.c = true;
  world.orientation = Eigen::AngleAxisd(0.5, Vec3::UnitZ());  // about the vertical
  HaplyService service(world);
  const auto device = open_haply(service.address());
  EXPECT_EQ(device->traits().sensed_axes, 6);
  DeviceReading reading;
  ASSERT_EQ(reading_fault(*device, reading), "");
  EXPECT_EQ(reading.buttons, 0b101u);
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  EXPECT_LT(reading.orientation.angularDistance(expected), 1e-9);

  world.b = true;
  world.a = false;
  world.orientation = Eigen::AngleAxisd(0.5, Vec3::UnitY());  // about what points away from the user
  service.set(world);
  ASSERT_EQ(reading_fault(*device, reading), "");  // the answer to what was sent before
  ASSERT_EQ(reading_fault(*device, reading), "");
  EXPECT_EQ(reading.buttons, 0b110u);
  const Eigen::Quaterniond rolled(Eigen::AngleAxisd(-0.5, Vec3::UnitZ()));
  EXPECT_LT(reading.orientation.angularDistance(rolled), 1e-9);

  world.orientation.coeffs().setZero();
  service.set(world);
  reading_fault(*device, reading);
  EXPECT_EQ(reading_fault(*device, reading), "the handle sent an orientation that is none");
  world.has_handle = false;
  service.set(world);
  reading_fault(*device, reading);
  EXPECT_EQ(reading_fault(*device, reading), "the handle is no longer in the states of the service");
}

TEST(Haply, NoHandleAndAWiredOne) {
  HaplyWorld world;
  world.has_handle = false;
  {
    HaplyService service(world);
    EXPECT_EQ(open_haply(service.address())->traits().sensed_axes, 3);
    EXPECT_HAS(refusal([&] { open_haply(service.address("?handle=61548")); }),
               "knows no handle \"61548\"; pair it");
  }
  world.has_handle = world.is_handle_wired = world.a = true;
  HaplyService service(world);
  const auto device = open_haply(service.address());
  DeviceReading reading;
  ASSERT_EQ(reading_fault(*device, reading), "");
  EXPECT_EQ(device->traits().sensed_axes, 6);
  EXPECT_EQ(reading.buttons, 1u);
}

TEST(Haply, DevicesByName) {
  HaplyWorld world;
  world.devices = {"049D", "04BA"};
  HaplyService service(world);
  DeviceReading reading;
  {
    const auto device = open_haply(service.address("?device=04BA"));
    ASSERT_EQ(reading_fault(*device, reading), "");
    EXPECT_EQ(reading.position_m, Vec3(9, 9, -9));
    ASSERT_EQ(reading_fault(*device, reading), "");
    EXPECT_EQ(service.commands().back().device_id, "04BA");
    world.devices = {"049D"};
    service.set(world);
    reading_fault(*device, reading);
    EXPECT_EQ(reading_fault(*device, reading), "the Inverse3 is no longer in the states of the service");
  }
  EXPECT_HAS(refusal([&] { open_haply(service.address("?device=04BA")); }),
             "knows no Inverse3 \"04BA\"; plug it in");
}

TEST(Haply, WhatCannotBeOpened) {
  int free_port = 0;
  { free_port = HaplyService().port(); }
  const std::string gone = "ws://127.0.0.1:" + std::to_string(free_port);
  EXPECT_HAS(refusal([&] { open_haply(gone); }), "haply:" + gone + ": no Haply service at " + gone + "/ (");
  EXPECT_HAS(refusal([&] { open_haply(gone); }), "start the Inverse service");
  EXPECT_HAS(refusal([&] { open_haply("http://127.0.0.1"); }), "write ws://HOST:PORT");
  EXPECT_HAS(refusal([&] { open_haply("ws://:1"); }), "write ws://HOST:PORT");
  EXPECT_HAS(refusal([&] { open_haply("ws://127.0.0.1?forse=values"); }),
             "has no setting \"forse\": expected force");
  EXPECT_HAS(refusal([&] { open_haply("?force=x"); }),
             "haply:?force=x: force is \"x\": expected vector, values");
  EXPECT_HAS(refusal([&] { open_haply("?rate=nan"); }),
             "rate is \"nan\": expected a number from 100 to 8000");
  HaplyWorld world;
  world.devices.clear();
  EXPECT_HAS(refusal([&] { open_haply(HaplyService(world).address()); }), "knows no Inverse3; plug it in");
  world = {};
  world.basis = "XZY";
  EXPECT_HAS(refusal([&] { open_haply(HaplyService(world).address()); }),
             "turn its axes to XZY; set the basis");
  world = {};
  world.answer = "{}";
  EXPECT_HAS(refusal([&] { open_haply(HaplyService(world).address()); }),
             "no first state (the Inverse3 is no longer");
  for (const char* inventory : {"garbage", "[]", "\xff\xff"}) {
    world = {};
    world.inventory = inventory;
    EXPECT_HAS(refusal([&] { open_haply(HaplyService(world).address()); }), "is this the Inverse service?");
  }
  HaplyService silent;
  silent.hang();
  const double began_s = steady_s();
  EXPECT_HAS(refusal([&] { open_haply(silent.address()); }),
             "it owes an inventory; is this the Inverse service?");
  EXPECT_LT(steady_s() - began_s, 1.5);
}

// The rate of commands at the service is that of the loop.
void expect_rate(double rate_hz, double lasts_s) {
  HaplyService service;
  const auto device = open_haply(service.address("?rate=" + std::to_string(static_cast<int>(rate_hz))));
  EXPECT_EQ(device->traits().tick_rate_hz, rate_hz);
  int ticks = 0, faults = 0;
  std::string last_fault;
  const double began_s = steady_s();
  run_in_a_thread(*device, [&] {
    DeviceReading reading;
    const DeviceFault read = device->read(reading), write = device->write(force({0, 0.2, 0}));
    if (read || write) last_fault = told(read) + " " + told(write), ++faults;
    ++ticks;
    return steady_s() - began_s < lasts_s;
  });
  const double took_s = steady_s() - began_s;
  EXPECT_LE(ticks, rate_hz * took_s + 2);
  EXPECT_GE(ticks, 0.05 * rate_hz * took_s) << "on a machine that is not overloaded";
  EXPECT_LE(faults, ticks / 20) << "of " << ticks << " ticks, at last " << last_fault;
  EXPECT_NEAR(static_cast<double>(service.commands().size()), ticks, 2 + faults);
  std::printf("%d ticks in %.2f s at %.0f Hz, %d faults\n", ticks, took_s, rate_hz, faults);
}

TEST(Haply, AThousandTicksASecond) {
  expect_rate(1000, 2);
}

TEST(Haply, FourThousandTicksASecond) {
  expect_rate(4000, 1);
}

// The service is in a process of its own: what it allocates is not counted.
TEST(Haply, NoAllocationInATick) {
  HaplyServiceProcess service;
  const auto device = open_haply(service.address());
  std::size_t allocations = 0;
  int ticks = 0, faults = 0;
  run_in_a_thread(*device, [&] {
    DeviceReading reading;
    const std::size_t before = allocation_count();
    if (device->read(reading)) ++faults;
    if (device->write(force({0.1, 0.2, 0.3}))) ++faults;
    allocations += allocation_count() - before;
    return ++ticks < 300;
  });
  EXPECT_EQ(allocations, 0u);
  EXPECT_LE(faults, 15);
}

TEST(Haply, Availability) {
  const Availability availability = haply_availability();
  EXPECT_TRUE(availability.compiled_in);
  EXPECT_FALSE(availability.detail.empty());
  EXPECT_EQ(availability.detail.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace remote_touch::haply_test
