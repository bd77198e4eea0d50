#include <mrpt/containers/yaml.h>

#include <chrono>
#include <cstdio>
#include <iostream>

#include "taut/odometry/Pipeline.h"
#include "taut/odometry/registerAll.h"
#include "taut/rawlog/RawlogSource.h"
#include "taut/trajectory/TrajectoryFile.h"

using namespace taut;

// prototype driver
int main(int argc, char** argv)
{
    registerAll();
    mrpt::containers::yaml y = mrpt::containers::yaml::Map();
    std::string input, output, config;
    int threads = 2;
    for (int i = 1; i < argc; i++)
    {
        std::string a = argv[i];
        if (a == "-i")
            input = argv[++i];
        else if (a == "-o")
            output = argv[++i];
        else if (a == "-j")
            threads = std::stoi(argv[++i]);
        else if (a == "-c")
            y = mrpt::containers::yaml::FromFile(argv[++i]);
        else
        {
            const auto eq = a.find('='), dot = a.find('.');
            const std::string s = a.substr(0, dot), k = a.substr(dot + 1, eq - dot - 1),
                              v = a.substr(eq + 1);
            if (!y.has(s)) y[s] = mrpt::containers::yaml::Map();
            y[s].asMap()[k] = v;
        }
    }
    ConfigSection root(y);
    OdometryConfig c = OdometryConfig::read(root);
    root.rejectUnknown();
    Executor executor(threads);
    WarningSink warn = [](const Warning& w)
    {
        std::fprintf(
            stderr, "W %.3f %s: %s\n", static_cast<double>(w.t) * 1e-9, w.kind.c_str(),
            w.text.c_str());
    };
    RawlogConfig rc;
    rc.path = input;
    RawlogSource source(rc, warn);
    std::vector<StampedPose> filtered, smoothed;
    StageTimes total;
    int n = 0;
    double iters = 0, corr = 0, feats = 0, bal = 0;
    FILE* states = std::fopen((output + ".states").c_str(), "w");
    Pipeline pipeline(
        c, executor, warn,
        [&](const Scan&, const ScanResult& r)
        {
            const auto& x = r.estimate.state;
            if (!smoothed.empty())
            {
                smoothed.back().T_world_imu = r.previous.T_world_imu;
            }
            filtered.push_back({x.t, x.T_world_imu});
            smoothed.push_back({x.t, x.T_world_imu});
            total.transform += r.times.transform;
            total.preintegrate += r.times.preintegrate;
            total.extract += r.times.extract;
            total.match += r.times.match;
            total.solve += r.times.solve;
            total.insert += r.times.insert;
            n++;
            iters += r.iterations;
            corr += r.correspondences;
            feats += r.features;
            bal += r.balance;
            std::fprintf(
                states,
                "%.6f p %.4f %.4f %.4f v %.3f %.3f %.3f ba %.4f %.4f %.4f bg %.5f %.5f %.5f it %d "
                "corr %d/%d bal %.2f mint %.3g minr %.3g cost %.1f\n",
                static_cast<double>(x.t) * 1e-9, x.T_world_imu.p.x(), x.T_world_imu.p.y(),
                x.T_world_imu.p.z(), x.v_world.x(), x.v_world.y(), x.v_world.z(), x.bias_accel.x(),
                x.bias_accel.y(), x.bias_accel.z(), x.bias_gyro.x(), x.bias_gyro.y(),
                x.bias_gyro.z(), r.iterations, r.correspondences, r.features, r.balance,
                r.min_translation[0], r.min_rotation[0], r.cost);
        });
    const auto t0 = std::chrono::steady_clock::now();
    while (auto m = source.next())
    {
        if (auto* s = std::get_if<ImuSample>(&*m))
            pipeline.add(*s);
        else
            pipeline.add(std::move(std::get<Scan>(*m)));
    }
    pipeline.finish();
    const double wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
    auto write = [](const std::string& f, const std::vector<StampedPose>& t)
    {
        TumWriter w(f);
        for (auto& p : t) w.write(p);
        w.close();
    };
    write(output, filtered);
    write(output + ".smooth", smoothed);
    std::fclose(states);
    std::printf(
        "n %d it %.2f feat %.0f corr %.0f bal %.2f | ms: tr %.2f pre %.2f ext %.2f match %.2f "
        "solve %.2f ins %.2f total %.2f wall/scan %.2f mapsize %zu\n",
        n, iters / n, feats / n, corr / n, bal / n, total.transform / n, total.preintegrate / n,
        total.extract / n, total.match / n, total.solve / n, total.insert / n, total.total() / n,
        wall * 1e3 / n, c.map->size());
}
