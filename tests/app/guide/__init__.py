"""Tests of the guide in the app."""
