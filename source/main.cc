#include <alluvium/application.h>

int main(int argc, char **argv)
{
  return alluvium::run_application(argc, argv);
}
