#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "taut/inspection/InspectionReport.h"

namespace
{
using namespace taut;
using testing::HasSubstr;
constexpr Time kFirst = 1'700'000'000'000'000'000;

Inspection example()
{
    Inspection i;
    i.log.first = kFirst;
    i.log.now = kFirst + 20'000'000'000;
    i.log.lidar_label = "TOP";
    i.log.sensors[{"TOP", "CObservationVelodyneScan"}] = 200;
    i.log.sensors[{"GPS", "CObservationGPS"}] = 20;
    i.lidar.emplace();
    i.lidar->scans = 200;
    i.lidar->rate = 10;
    i.imu.emplace();
    i.imu->samples = 4000;
    i.imu->accel_unit = {"g", 9.80665};
    i.imu->gyro_unit = {"rad/s", 1};
    i.rotation.emplace();
    i.rotation->begin = kFirst;
    i.rotation->end = kFirst + 1'000'000'000;
    i.rotation->alignment.clock_offset = 0.004;
    i.rotation->alignment.clock_sigma = 0.0002;
    i.rotation->offset_known = i.rotation->rotation_known = true;
    i.findings.push_back(
        {kFirst + 2'500'000'000, "imu_gap", 0.3, "s", 2, "no IMU sample", "look at the cable"});
    i.findings.push_back({0, "no_imu", 0, "", 1, "no IMU", "record one"});
    return i;
}

TEST(TheReport, ForPeopleTellsSensorsFactsAndFindings)
{
    const std::string text = inspectionAsText(example());
    for (const char* part :
         {"'TOP'", "CObservationGPS", "20.000 s", "200 scans, 10.00 Hz", "no rest", "+4.00 ms",
          "2 findings", "[imu_gap] at 2.500 s: no IMU sample (2 times)", "look at the cable",
          "[no_imu]: no IMU\n"})
        EXPECT_THAT(text, HasSubstr(part));
    Inspection clean = example();
    clean.findings.clear();
    EXPECT_THAT(inspectionAsText(clean), HasSubstr("no findings"));
}

TEST(TheReport, SaysWhyNothingWasEstimated)
{
    Inspection i = example();
    i.rotation->not_estimated = "the body hardly turns";
    EXPECT_THAT(inspectionAsText(i), HasSubstr("cannot be estimated: the body hardly turns"));
    const auto json = nlohmann::json::parse(inspectionAsJson(i));
    EXPECT_TRUE(json["rotation"]["clock_offset"].is_null());
    EXPECT_EQ(json["rotation"]["not_estimated"], "the body hardly turns");
}

TEST(TheReport, ForProgramsIsJsonWithAllOfIt)
{
    const auto json = nlohmann::json::parse(inspectionAsJson(example()));
    EXPECT_EQ(json["sensors"].size(), 2U);
    EXPECT_EQ(json["lidar"]["label"], "TOP");
    EXPECT_EQ(json["imu"]["accel_unit"], "g");
    EXPECT_TRUE(json["imu"]["rest"].is_null());
    EXPECT_DOUBLE_EQ(json["rotation"]["clock_offset"]["value_s"], 0.004);
    ASSERT_EQ(json["findings"].size(), 2U);
    EXPECT_EQ(json["findings"][0]["kind"], "imu_gap");
    EXPECT_DOUBLE_EQ(json["findings"][0]["since_start_s"], 2.5);
    EXPECT_EQ(json["findings"][0]["count"], 2);
    EXPECT_EQ(json["findings"][0]["advice"], "look at the cable");
    EXPECT_TRUE(json["findings"][1]["t_s"].is_null());
}

TEST(TheReport, OfALogWithOneSensorHasNoOther)
{
    Inspection i = example();
    i.imu.reset();
    i.rotation.reset();
    const auto json = nlohmann::json::parse(inspectionAsJson(i));
    EXPECT_TRUE(json["imu"].is_null());
    EXPECT_TRUE(json["rotation"].is_null());
    EXPECT_THAT(inspectionAsText(i), testing::Not(HasSubstr("IMU '")));
}

TEST(TheReport, TakesLabelsThatAreNoText)
{
    Inspection i = example();
    i.log.sensors[{"\xff\xfe", "CObservationIMU"}] = 1;
    EXPECT_TRUE(nlohmann::json::accept(inspectionAsJson(i)));
}
}  // namespace
