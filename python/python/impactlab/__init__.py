"""What happens when one vehicle hits another, and in the second after.

A question is a dictionary, as ``impactlab ... --print-request`` prints it; ``schema`` says every key with its
unit. Everything is in SI units and radians. The answer is that of the command line to the last bit; what
restricts it stands under ``"caveats"``.
"""

from impactlab._impactlab import (
    Forecast,
    ImpactlabError,
    Motion,
    Reconstruction,
    __version__,
    ask,
    plan_sweep,
    predict,
    reconstruct,
    run_chunk,
    schema,
    simulate,
)

__all__ = [
    "Forecast",
    "ImpactlabError",
    "Motion",
    "Reconstruction",
    "__version__",
    "ask",
    "plan_sweep",
    "predict",
    "reconstruct",
    "run_chunk",
    "schema",
    "simulate",
]
