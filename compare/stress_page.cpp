#include "compare/stress_page.h"
namespace arealab {
void WriteStressPage(const StressResult&, const std::filesystem::path&) {}
}  // namespace arealab
