#include "taut/simulation/Scenario.h"
#include "support.h"

/* A scenario of the simulator; what took effect reads back to the same. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    fuzz::readOrRefuse(
        [&]
        {
            ConfigSection root(parseYaml(input.text(), "scenario.yaml"), "", "scenario.yaml");
            simulation::readScenario(root);
            const std::string effective = root.effective();
            ConfigSection again(parseYaml(effective));
            simulation::readScenario(again);
            fuzz::require(again.effective() == effective, "what took effect takes effect again");
        });
}
