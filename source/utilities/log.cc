#include <alluvium/utilities/log.h>

#include <iostream>
#include <streambuf>

#include <fcntl.h>
#include <unistd.h>

namespace alluvium
{
  Log *Log::instance = nullptr;


  class Log::Implementation
  {
  public:
    /** Hands everything on to the stream's own buffer, and whole lines to the log. */
    class Tee : public std::streambuf
    {
    public:
      Tee(Implementation &log, std::ostream &stream)
        : log(log)
        , stream(stream)
        , screen(stream.rdbuf(this))
      {}

      ~Tee() override
      {
        if (!line.empty())
          log.write(line + '\n');
        stream.rdbuf(screen);
      }

    protected:
      int overflow(const int c) override
      {
        if (c == traits_type::eof())
          return traits_type::not_eof(c);
        keep(static_cast<char>(c));
        return screen->sputc(static_cast<char>(c));
      }

      std::streamsize xsputn(const char *text, const std::streamsize n) override
      {
        for (std::streamsize i = 0; i < n; ++i)
          keep(text[i]);
        return screen->sputn(text, n);
      }

      int sync() override { return screen->pubsync(); }

    private:
      void keep(const char c)
      {
        if (c == '\r') // a progress bar draws itself anew
          line.clear();
        else
          line += c;
        if (c != '\n')
          return;
        const std::string erase = "\033[K";
        for (auto at = line.find(erase); at != std::string::npos; at = line.find(erase))
          line.erase(at, erase.size());
        log.write(line);
        line.clear();
      }

      Implementation &log;
      std::ostream   &stream;
      std::streambuf *screen;
      std::string     line;
    };

    explicit Implementation(const bool errors_only)
      : out(errors_only ? nullptr : std::make_unique<Tee>(*this, std::cout))
      , err(std::make_unique<Tee>(*this, std::cerr))
    {}

    ~Implementation()
    {
      err.reset();
      out.reset();
      if (file >= 0)
        close(file);
    }

    /** Files of ranks that have nothing to say are not opened at all. */
    void write(const std::string &text)
    {
      constexpr std::size_t most = 1 << 20;
      if (file_name.empty())
        {
          if (kept.size() < most)
            kept += text;
          return;
        }
      if (file < 0)
        file = ::open(file_name.c_str(), O_WRONLY | O_CREAT | O_APPEND | (anew ? O_TRUNC : 0), 0666);
      if (file >= 0 && ::write(file, text.data(), text.size()) < 0)
        return; // the screen has it
    }

    std::string          file_name, kept;
    bool                 anew = false;
    int                  file = -1;
    std::unique_ptr<Tee> out, err;
  };


  Log::Log(const bool errors_only)
    : implementation(std::make_unique<Implementation>(errors_only))
  {
    instance = this;
  }

  Log::~Log()
  {
    instance = nullptr;
  }

  void Log::open(const std::string &file_name, const std::string &headline, const bool append)
  {
    if (instance == nullptr)
      return;
    Implementation &my = *instance->implementation;
    my.file_name       = file_name;
    my.anew            = !append;
    if (my.out)
      my.write(headline + '\n');
    my.anew = false;
    if (!my.kept.empty())
      my.write(my.kept);
    my.kept.clear();
  }
} // namespace alluvium
