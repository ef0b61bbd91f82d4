/* The header may be included twice, in C and in C++. */
#include "mm_control.h"
#include "mm_control.h"

int main(void)
{
    mm_params params;
    params.law = MM_LAW_BFSMC;
    params.estimator.kind = MM_ESTIMATOR_KIND_NONE;
    mm_status status = mm_params_thesis(&params);
    return status == MM_STATUS_OK ? 0 : 1;
}
