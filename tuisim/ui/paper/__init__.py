"""What leaves the screen: charts as SVG, PNG or text, and the report of a run as a page. No Textual here."""
