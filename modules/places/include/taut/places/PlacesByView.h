#pragma once

#include "taut/core/PlaceRecognizer.h"
#include "taut/places/ViewFromAbove.h"

namespace taut
{
struct PlacesByViewConfig
{
    double unsure = 5;        //!< [m] where the graph is surer of a pair than that, nobody is asked
    double min_score = 0.35;  //!< of a match
    int min_cells = 20;       //!< in which something stands; a view with fewer tells nothing
    int most = 4;             //!< candidates of a submap
};

/** Candidates by what a place looks like from above, for pairs of submaps of which the graph does
 * not know where they are to each other: of two recordings, or after the pose was lost. Gravity
 * tells roll and pitch, so that a turn, a shift and a height are looked for, all of them. */
class PlacesByView : public PlaceRecognizer
{
    DEFINE_MRPT_OBJECT(PlacesByView, taut)
 public:
    void configure(ConfigSection& section) override;
    void add(const Submap& submap) override;
    std::vector<LoopCandidate> candidates(
        VertexId id, const PlaceKnowledge& knowledge) const override;

    PlacesByViewConfig config;

 private:
    struct Place
    {
        VertexId id = 0;
        ViewFromAbove view;
    };
    bool isUnsure(VertexId from, VertexId to, const PlaceKnowledge& knowledge) const;

    std::vector<Place> places_;  // by id
};
}  // namespace taut
