"""What every room may use: errors, frozen values, files and folders, texts of programs. It knows no robot."""
