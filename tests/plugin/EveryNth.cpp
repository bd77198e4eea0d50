/** A feature extractor that taut does not have: every n-th point, whatever it is. */
#include <mrpt/core/initializer.h>
#include <taut/core/FeatureExtractor.h>

#include <algorithm>

namespace example
{
class EveryNth : public taut::FeatureExtractor
{
    DEFINE_MRPT_OBJECT(EveryNth, example)
 public:
    void configure(taut::ConfigSection& section) override
    {
        section.key("step", step_, {1, 1e6}, "of so many points one is kept");
    }

    taut::Features extract(const taut::Scan& scan, const taut::WarningSink& /*warn*/) const override
    {
        taut::Features features;
        features.stamp = scan.stamp;
        for (std::size_t i = 0; i < scan.points.size(); i += static_cast<std::size_t>(step_))
        {
            const taut::LidarPoint& p = scan.points[i];
            if (p.position.allFinite())
                features.points.push_back({p.position, p.offset, taut::FeatureKind::Any});
        }
        std::stable_sort(
            features.points.begin(), features.points.end(),
            [](const taut::Feature& a, const taut::Feature& b) { return a.offset < b.offset; });
        return features;
    }

 private:
    int step_ = 2;
};
}  // namespace example

IMPLEMENTS_MRPT_OBJECT(EveryNth, taut::FeatureExtractor, example)

// When the library is loaded, the class becomes known to the class factory by its name.
MRPT_INITIALIZER(register_every_nth)
{
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(EveryNth, example));
}
