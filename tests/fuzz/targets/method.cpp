#include "taut/session/Method.h"
#include "support.h"
#include "taut/render/OSMesaRenderer.h"
#include "taut/session/registerSession.h"

/* A method file. What took effect reads back to the same. */
TAUT_FUZZ_TARGET(input)
{
    using namespace taut;
    static const bool registered = (registerSession(), registerRenderers(), true);
    fuzz::require(registered, "the classes are known");
    fuzz::readOrRefuse(
        [&]
        {
            const YamlNode node = parseYaml(input.text(), "method.yaml");
            fuzz::require(
                yamlText(parseYaml(yamlText(node))) == yamlText(node),
                "YAML that is written reads back");
            ConfigSection root(node, "", "method.yaml");
            const std::string effective = Method::read(root, std::nullopt).effective;
            ConfigSection again(parseYaml(effective));
            fuzz::require(
                Method::read(again, std::nullopt).effective == effective,
                "what took effect takes effect again");
        });
}
