#pragma once

#include "taut/core/PlaceRecognizer.h"

namespace taut
{
struct NearbyPlacesConfig
{
    double sigmas = 3;         //!< of the graph's uncertainty that are searched
    double overlap = 1;        //!< reaches of the farther-seeing submap that two paths may be apart
    double min_way = 1.5;      //!< reaches on the way between them: nearer ones are odometry again
    double max_distance = 50;  //!< [m] further apart nobody is looked for, however uncertain
    int most = 3;              //!< candidates of a submap
};

/** Candidates by the graph's own estimate: submaps whose paths may have come near each other, as
 * far as the graph's uncertainty says. */
class NearbyPlaces : public PlaceRecognizer
{
    DEFINE_MRPT_OBJECT(NearbyPlaces, taut)
 public:
    void configure(ConfigSection& section) override;
    void add(const Submap& submap) override;
    std::vector<LoopCandidate> candidates(
        VertexId id, const PlaceKnowledge& knowledge) const override;

    NearbyPlacesConfig config;

 private:
    /** What is kept of a submap. */
    struct Place
    {
        VertexId id = 0;
        double path_begin = 0, path_end = 0, reach = 0;
        std::vector<Vector3d> way;  //!< of the body, submap frame
    };

    static double distance(const Place& from, const Place& to, const Pose& T_from_to);

    std::vector<Place> places_;  // by id
};
}  // namespace taut
