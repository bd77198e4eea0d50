// A whole run inside another program: from a rawlog to a folder of results, with a line for each
// thing that happens.
//   example_embed LOG.rawlog FOLDER [SECONDS_OF_REST]
#include <filesystem>
#include <iostream>
#include <string>

#include "taut/rawlog/PrefetchedRawlog.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/Session.h"
#include "taut/session/registerSession.h"

using namespace taut;

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::cerr << "usage: example_embed LOG.rawlog FOLDER [SECONDS_OF_REST]\n";
        return 2;
    }
    try
    {
        registerSession();
        registerRenderers();
        WarningLog warnings([](const Warning& w)
                            { std::cerr << w.kind << ": " << w.text << '\n'; });

        SessionConfig config;
        ConfigSection defaults;  // no method file: the defaults
        config.method = Method::read(defaults, std::nullopt);
        if (argc > 3) config.method.odometry.initialization.rest_duration = std::stod(argv[3]);
        config.input = argv[1];
        config.folder = argv[2];
        config.threads = 2;
        config.pictures = false;
        std::filesystem::create_directories(config.folder);

        RawlogConfig log_config;
        log_config.path = argv[1];
        PrefetchedRawlog log(log_config, warnings.sink());
        Session session(
            config, warnings,
            [](const Event& event)
            {
                if (const auto* started = std::get_if<Started>(&event))
                    std::cout << "started "
                              << (started->initialization.at_rest ? "at rest" : "in motion")
                              << '\n';
                if (const auto* lost = std::get_if<Lost>(&event))
                    std::cout << "in doubt: " << lost->cause << '\n';
                if (std::holds_alternative<Recovered>(event)) std::cout << "recovered\n";
            });
        const SessionOutcome outcome = session.run(log, [](double) { return true; });
        std::cout << outcome.poses << " poses, " << outcome.length << " m\n";
        return outcome.failure.empty() ? 0 : 1;
    }
    catch (const std::exception& e)
    {
        std::cerr << e.what() << '\n';
        return 1;
    }
}
