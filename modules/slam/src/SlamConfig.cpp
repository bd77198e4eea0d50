#include "taut/slam/SlamConfig.h"

namespace taut
{
SlamConfig SlamConfig::read(ConfigSection& s, const Prototype<Map>& map)
{
    SlamConfig c;
    s.key("loops", c.loops, "close loops; else the odometry's path is the result");
    c.submap.declare(s.section("submap"));
    c.judge.declare(s.section("closure"));
    c.places = Prototype<PlaceRecognizer>(
        createConfigured<PlaceRecognizer>(s.section("places"), "taut::NearbyPlaces"));
    c.appearance = Prototype<PlaceRecognizer>(
        createConfigured<PlaceRecognizer>(s.section("appearance"), "taut::PlacesByView"));
    c.optimizer = Prototype<GraphOptimizer>(
        createConfigured<GraphOptimizer>(s.section("graph"), "taut::SparseGraphOptimizer"));
    c.map = map;
    return c;
}
}  // namespace taut
