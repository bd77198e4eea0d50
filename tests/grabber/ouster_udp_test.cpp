/** The driver of an Ouster, fed over the loopback. */
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>

#include "OusterSimulator.h"
#include "data_folder.h"
#include "grabber_support.h"
#include "taut/importing/pcap/PcapReader.h"
#include "temporary_folder.h"

namespace taut::test
{
namespace
{
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationVelodyneScan;
using testing::HasSubstr;

/** A UDP socket of the loopback. */
class LoopbackSocket
{
 public:
    LoopbackSocket() : file_(socket(AF_INET, SOCK_DGRAM, 0))
    {
        const sockaddr_in any = at(0);
        EXPECT_EQ(bind(file_, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);
    }
    ~LoopbackSocket() { close(file_); }
    LoopbackSocket(const LoopbackSocket&) = delete;
    LoopbackSocket& operator=(const LoopbackSocket&) = delete;

    int port() const
    {
        sockaddr_in bound{};
        socklen_t size = sizeof bound;
        getsockname(file_, reinterpret_cast<sockaddr*>(&bound), &size);
        return ntohs(bound.sin_port);
    }

    void send(int port, const std::vector<std::uint8_t>& bytes) const
    {
        const sockaddr_in to = at(port);
        const auto sent = sendto(
            file_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
            sizeof to);
        EXPECT_EQ(sent, static_cast<ssize_t>(bytes.size()));
    }

 private:
    static sockaddr_in at(int port)
    {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        return address;
    }

    int file_;
};

class AnOusterOnTheNetwork : public testing::Test
{
 protected:
    AnOusterOnTheNetwork()
    {
        const LoopbackSocket lidar, imu;  // ports that are free
        lidar_port_ = lidar.port();
        imu_port_ = imu.port();
    }

    void start(const std::string& json, const std::string& more = "")
    {
        const mrpt::config::CConfigFileMemory config(
            "[OUSTER]\ndriver = OusterUdp\nprocess_rate = 100\nbind_address = 127.0.0.1\n"
            "lidar_label = TOP\nimu_label = BODY\npose_x = 1\npose_yaw = 90\nouster_json = " +
            json + "\nlidar_port = " + std::to_string(lidar_port_) +
            "\nimu_port = " + std::to_string(imu_port_) + "\n" + more);
        driver_ = makeSensor(config, "OUSTER");
        driver_->initialize();
    }

    /** The description of the simulated sensor in a file. */
    std::string description()
    {
        const std::string path = folder_ / "sensor.json";
        std::ofstream(path) << simulated_.description();
        return path;
    }

    void send(int port, const std::vector<std::uint8_t>& bytes)
    {
        sensor_.send(port, bytes);
        driver_->doProcess();
        for (const auto& [t, object] : driver_->getObservations())
        {
            if (auto scan = std::dynamic_pointer_cast<CObservationVelodyneScan>(object))
                scans_.push_back(scan);
            if (auto sample = std::dynamic_pointer_cast<CObservationIMU>(object))
                imu_.push_back(sample);
        }
    }

    void sendFrame(int frame)
    {
        for (int i = 0; i < simulated_.packetsPerFrame(); i++)
            send(lidar_port_, simulated_.packet(frame, i));
    }

    const TemporaryFolder folder_;
    const LoopbackSocket sensor_;
    OusterSimulator simulated_;
    int lidar_port_ = 0, imu_port_ = 0;
    mrpt::hwdrivers::CGenericSensor::Ptr driver_;
    std::vector<CObservationVelodyneScan::Ptr> scans_;
    std::vector<CObservationIMU::Ptr> imu_;
};

TEST_F(AnOusterOnTheNetwork, GivesItsTurnsAndSamples)
{
    start(description());
    sendFrame(0);
    EXPECT_EQ(scans_.size(), 0U);
    ImuSample sample;
    sample.t = simulated_.columnTime(1, 0);
    sample.accel = {0.1, -0.2, 9.8};
    sample.gyro = {0.3, 0.2, -0.1};
    send(imu_port_, OusterSimulator::imuPacket(sample));
    sendFrame(1);
    ASSERT_EQ(scans_.size(), 1U);
    const auto& cloud = scans_[0]->point_cloud;
    std::size_t i = 0;
    for (int column = 0; column < simulated_.columns; column++)
        for (int pixel = 0; pixel < simulated_.pixels; pixel++)
        {
            if (simulated_.range_mm(0, column, pixel) == 0) continue;
            ASSERT_LT(i, cloud.x.size());
            const Vector3d p = simulated_.point(0, column, pixel);
            EXPECT_LT((Vector3d(cloud.x[i], cloud.y[i], cloud.z[i]) - p).norm(), 1e-4);
            EXPECT_EQ(cloud.laser_id[i++], pixel);
        }
    EXPECT_EQ(i, cloud.x.size());
    EXPECT_EQ(scans_[0]->sensorLabel, "TOP");
    ASSERT_EQ(imu_.size(), 1U);
    EXPECT_EQ(imu_[0]->sensorLabel, "BODY");
    EXPECT_NEAR(imu_[0]->get(mrpt::obs::IMU_Y_ACC), -0.2, 1e-6);
    EXPECT_NEAR(imu_[0]->get(mrpt::obs::IMU_WX), 0.3, 1e-6);
    EXPECT_NEAR(imu_[0]->sensorPose.x(), 1, 1e-9);
    EXPECT_NEAR(imu_[0]->sensorPose.yaw(), M_PI / 2, 1e-9);
    // One clock for both, and the day of today for a clock that counts from the sensor's start.
    EXPECT_NEAR(
        mrpt::system::timeDifference(scans_[0]->timestamp, imu_[0]->timestamp),
        toSeconds(sample.t - simulated_.columnTime(0, 0)), 1e-6);
    EXPECT_LT(std::abs(mrpt::system::timeDifference(scans_[0]->timestamp, mrpt::Clock::now())), 60);
}

TEST_F(AnOusterOnTheNetwork, ByTheComputersClockIsStampedWhenItsPacketsCome)
{
    start(description(), "computer_clock = true\n");
    const auto before = mrpt::Clock::now();
    send(imu_port_, OusterSimulator::imuPacket({}));
    ASSERT_EQ(imu_.size(), 1U);
    EXPECT_GE(mrpt::system::timeDifference(before, imu_[0]->timestamp), -1e-3);
    EXPECT_LE(mrpt::system::timeDifference(imu_[0]->timestamp, mrpt::Clock::now()), 60);
}

TEST_F(AnOusterOnTheNetwork, IsNotDisturbedByWhatIsNoPacketOfItOrOfAnother)
{
    start(description(), "device_ip = 127.0.0.1\n");
    send(imu_port_, {1, 2, 3});
    sendFrame(0);
    sendFrame(1);
    EXPECT_EQ(scans_.size(), 1U);

    start(description(), "device_ip = 192.0.2.1\n");
    sendFrame(2);
    sendFrame(3);
    EXPECT_EQ(scans_.size(), 1U);
}

TEST_F(AnOusterOnTheNetwork, IsRefusedWhereItIsNotTheOneDescribed)
{
    const auto failure = [](const auto& action)
    {
        try
        {
            action();
        }
        catch (const std::exception& e)
        {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_THAT(failure([&] { start(""); }), HasSubstr("no ouster_json"));
    EXPECT_THAT(failure([&] { start(folder_ / "none.json"); }), HasSubstr("cannot read"));
    EXPECT_THAT(
        failure([&] { start(description(), "bind_address = nowhere\n"); }),
        HasSubstr("no IPv4 address"));
    const LoopbackSocket taken;
    lidar_port_ = taken.port();
    EXPECT_THAT(
        failure([&] { start(description()); }),
        HasSubstr("cannot listen at UDP port " + std::to_string(taken.port())));
    lidar_port_ = LoopbackSocket().port();
    start(description());
    OusterSimulator other;
    other.pixels = 32;
    EXPECT_THAT(
        failure([&] { send(lidar_port_, other.packet(0, 0)); }),
        HasSubstr("of another sensor or setting"));
}

// A real one: its capture sent again. The turn that goes on at the end is not complete.
TEST_F(AnOusterOnTheNetwork, ThatIsRealGivesWhatItsFactsSay)
{
    const auto pcap = dataFolder() / "pcap/ouster_os1_128.pcap";
    if (!std::filesystem::exists(pcap)) return skipWithout("ouster_os1_128.pcap");
    const auto facts =
        nlohmann::json::parse(std::ifstream(dataFolder() / "pcap/ouster_os1_128.facts.json"));
    start((dataFolder() / "pcap/ouster_os1_128.json").string());
    PcapReader reader(pcap.string());
    while (const auto datagram = reader.next())
        send(datagram->to_port == 7503 ? imu_port_ : lidar_port_, datagram->payload);
    ASSERT_EQ(scans_.size(), 2U);
    for (std::size_t i = 0; i < scans_.size(); i++)
        EXPECT_EQ(scans_[i]->point_cloud.x.size(), facts["frames"][i]["valid_returns"]);
    ASSERT_EQ(imu_.size(), facts["imu_packets"]);
    double mean = 0;
    for (const auto& sample : imu_)
        mean += sample->get(mrpt::obs::IMU_Z_ACC) / static_cast<double>(imu_.size());
    EXPECT_NEAR(mean, facts["imu_acc_mean_ms2"][2].get<double>(), 1e-6);
}
}  // namespace
}  // namespace taut::test
