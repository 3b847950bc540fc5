"""The cases that have shown a fault, which was mended: each stays a quick test."""

from __future__ import annotations

from collections.abc import Sequence

FOUND: Sequence[tuple[str, str]] = (
    ("damage", "arrow:1013840480"),
    ("damage", "arrow:1104241721:value"),
    ("damage", "arrow:1112074422"),
    ("damage", "arrow:116652808:value"),
    ("damage", "arrow:1306604838:value"),
    ("damage", "arrow:2069109442:value"),
    ("damage", "arrow:2079769798"),
    ("damage", "arrow:2208802654"),
    ("damage", "arrow:3138981886"),
    ("damage", "arrow:3568964177"),
    ("damage", "batch:1302420243"),
    ("damage", "catalogue:554407099"),
    ("damage", "csv:1619606507:edge"),
    ("damage", "goals:1490831057"),
    ("damage", "jsonl:2802776020"),
    ("damage", "jsonl:3488657884"),
    ("damage", "marks:115627938:value"),
    ("damage", "parquet:1485874645"),
    ("damage", "parquet:1560589855"),
    ("damage", "parquet:2962725307:value"),
    ("damage", "parquet:3152310975:value"),
    ("damage", "parquet:3496095300:value"),
    ("damage", "parquet:644934153"),
    ("damage", "progress:4157507265:value"),
    ("damage", "run:183:text"),
    ("damage", "run:2508605289"),
    ("damage", "run:2527031845:value"),
    ("damage", "run:2445617949:edge"),
    ("damage", "run:3138339898"),
    ("damage", "run:3463462202:text"),
    ("damage", "run:1180655197:text"),
    ("damage", "run:369608953:text"),
    ("damage", "run:4217672325:value"),
    ("damage", "run:896353295:value"),
    ("replays", "dragged:11"),
    ("replays", "dragged:209"),
    ("replays", "honest:2470914290"),
)
"""Kind, and name of the case."""
