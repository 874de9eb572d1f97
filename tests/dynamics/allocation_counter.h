#pragma once

/// Number of calls of operator new in this test program so far.
long allocations();
