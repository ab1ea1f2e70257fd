#include <alluvium/coupling/grain_bins.h>

#include <algorithm>

namespace alluvium::coupling
{
  GrainBins::GrainBins(const std::vector<double> &x, const std::vector<double> &y, const double width)
    : width(width)
  {
    lower = {{*std::min_element(x.begin(), x.end()), *std::min_element(y.begin(), y.end())}};
    const std::array<double, 2> upper = {
      {*std::max_element(x.begin(), x.end()), *std::max_element(y.begin(), y.end())}};
    // discs that lie far apart must not cost the memory of all the bins in between
    while (((upper[0] - lower[0]) / this->width + 1.) * ((upper[1] - lower[1]) / this->width + 1.) >
           1024. + 8. * x.size())
      this->width *= 1.5;
    for (unsigned int d = 0; d < 2; ++d)
      n[d] = 1 + static_cast<int>((upper[d] - lower[d]) / this->width);
    begin.assign(n[0] * n[1] + 1, 0);
    std::vector<int> bin(x.size());
    for (std::size_t g = 0; g < x.size(); ++g)
      {
        bin[g] = index(y[g], 1) * n[0] + index(x[g], 0);
        ++begin[bin[g] + 1];
      }
    for (std::size_t b = 1; b < begin.size(); ++b)
      begin[b] += begin[b - 1];
    member.resize(x.size());
    std::vector<unsigned int> next(begin.begin(), begin.end() - 1);
    for (std::size_t g = 0; g < x.size(); ++g)
      member[next[bin[g]]++] = g;
  }


  void GrainBins::find(const std::array<double, 2> &low,
                       const std::array<double, 2> &high,
                       std::vector<unsigned int>   &found) const
  {
    found.clear();
    for (unsigned int d = 0; d < 2; ++d)
      if (high[d] < lower[d] || low[d] > lower[d] + n[d] * width)
        return;
    const int i0 = index(low[0], 0), i1 = index(high[0], 0);
    for (int j = index(low[1], 1); j <= index(high[1], 1); ++j)
      found.insert(found.end(), member.begin() + begin[j * n[0] + i0], member.begin() + begin[j * n[0] + i1 + 1]);
    std::sort(found.begin(), found.end());
  }


  void GrainBins::mark(const double x, const double y)
  {
    marked.resize(begin.size() - 1, 0);
    marked[index(y, 1) * n[0] + index(x, 0)] = 1;
  }


  bool GrainBins::is_marked(const std::array<double, 2> &low, const std::array<double, 2> &high) const
  {
    const int i0 = index(low[0], 0), i1 = index(high[0], 0);
    for (int j = index(low[1], 1); j <= index(high[1], 1); ++j)
      if (std::any_of(marked.begin() + j * n[0] + i0, marked.begin() + j * n[0] + i1 + 1, [](auto m) { return m; }))
        return true;
    return false;
  }


  int GrainBins::index(const double x, const unsigned int d) const
  {
    return std::clamp(static_cast<int>((x - lower[d]) / width), 0, n[d] - 1);
  }
} // namespace alluvium::coupling
