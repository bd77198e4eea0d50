#include "support.h"
#include "taut/packets/hesai/FrameAssembler.h"

/* The correction file of a Hesai. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const fuzz::Folder folder;
    const std::string path = folder.write("a.csv", input);
    fuzz::readOrRefuse(
        [&]
        {
            const hesai::Calibration calibration = hesai::loadCorrection(path);
            for (int model = 0; model <= static_cast<int>(hesai::Model::Xt32M); model++)
                fuzz::readOrRefuse(
                    [&]
                    {
                        hesai::checkCorrection(calibration, static_cast<hesai::Model>(model));
                        const hesai::FrameAssembler frames(
                            static_cast<hesai::Model>(model), calibration);
                    });
        });
}
