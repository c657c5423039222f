#include "compare/context.h"
